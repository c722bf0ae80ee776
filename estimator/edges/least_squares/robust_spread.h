#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace saccade {

/// Normalised residuals beyond this count as outliers.
inline constexpr double kInlier = 2.4;

/// Square of a normalised residual for the spread of many: outliers weigh like the worst inlier.
[[nodiscard]] inline double clipped_square(double residual) {
  return std::min(residual * residual, kInlier * kInlier);
}

/// The middle one of some values (of an even number, the upper), which are reordered.
template <class T>
[[nodiscard]] T median_of(std::vector<T>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

struct WeightedValue {
  double value = 0;
  double weight = 0;  ///< >= 0
};

/// The value up to which half of the weight lies, of values that are reordered; 0 for none.
[[nodiscard]] inline double weighted_median(std::vector<WeightedValue>& values) {
  std::sort(values.begin(), values.end(),
            [](const WeightedValue& a, const WeightedValue& b) { return a.value < b.value; });
  double rest = 0;
  for (const WeightedValue& value : values) rest += value.weight / 2;
  for (const WeightedValue& value : values)
    if ((rest -= value.weight) <= 0) return value.value;
  return 0;
}

/// Deviation of a Gaussian with the median of these absolute values, which are reordered.
[[nodiscard]] inline double gaussian_sigma(std::vector<double>& absolute) {
  return 1.4826 * median_of(absolute);
}

}  // namespace saccade
