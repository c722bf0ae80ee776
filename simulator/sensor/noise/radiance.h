#pragma once

#include <algorithm>
#include <cmath>

namespace saccade {

/// I of L = ln(eps + I); never below 0.
[[nodiscard]] inline double radiance_from_log(double log_intensity, double log_eps) {
  return std::max(0.0, std::exp(log_intensity) - log_eps);
}

}  // namespace saccade
