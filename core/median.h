#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "core/check.h"

namespace saccade {

/// The middle value; of an even number of values the mean of the two in the middle. Contract: at
/// least one.
[[nodiscard]] inline double median(std::vector<double> values) {
  SACCADE_CHECK(!values.empty());
  const std::size_t n = values.size();
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(n / 2);
  std::nth_element(values.begin(), middle, values.end());
  return n % 2 == 1 ? *middle : (*std::max_element(values.begin(), middle) + *middle) / 2;
}

}  // namespace saccade
