#pragma once

#include <cmath>
#include <cstddef>
#include <numbers>

namespace saccade {

/// Whether a pixel belongs to a `fraction` of all, evenly spread over the sensor: multiples of the
/// golden ratio's fraction spread evenly, however many of them are taken.
[[nodiscard]] inline bool is_chosen(std::size_t pixel, double fraction) {
  const double x = static_cast<double>(pixel) * (std::numbers::phi - 1);
  return x - std::floor(x) < fraction;
}

}  // namespace saccade
