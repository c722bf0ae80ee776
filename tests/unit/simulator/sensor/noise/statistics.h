#pragma once

#include <cmath>
#include <span>

namespace saccade {

/// How far a test's statistic may lie from its expectation [standard deviations]: a correct model
/// fails with probability 6e-7, and as seeds are fixed, it fails on the first run or never.
constexpr double kSigmas = 5;

/// Bound of a chi-square variable with `degrees` of freedom that is exceeded as rarely as a normal
/// one exceeds `sigmas` (Wilson and Hilferty 1931); negative sigmas give the lower bound.
inline double chi_square_bound(double degrees, double sigmas) {
  const double spread = 2 / (9 * degrees);
  return degrees * std::pow(1 - spread + sigmas * std::sqrt(spread), 3);
}

struct Moments {
  double mean = 0;
  double variance = 0;  ///< unbiased
};

inline Moments moments_of(std::span<const double> values) {
  const auto count = static_cast<double>(values.size());
  Moments moments;
  for (const double value : values) moments.mean += value / count;
  for (const double value : values)
    moments.variance += (value - moments.mean) * (value - moments.mean) / (count - 1);
  return moments;
}

/// Share of a standard normal variable below z.
inline double normal_share_below(double z) { return 0.5 * std::erfc(-z / std::sqrt(2.0)); }

}  // namespace saccade
