#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace saccade {

struct ResampleOptions {
  int resamples = 10000;  ///< >= 100
  /// Probability beyond each end of the interval, in (0, 0.5).
  double tail = 0.005;
  std::uint64_t seed = 1;  ///< of the resamples; equal input gives equal output
};

/// The smallest sample size of bootstrap_mean(). Of n values, n^(1 - n) of the resamples consist of
/// a single value and have no spread: 0.0001 of them at six, but 0.016 at four.
inline constexpr std::size_t kLeastForBootstrap = 6;

/// A mean with its confidence interval and the evidence for its sign.
struct BootstrapMean {
  double mean = 0;
  double low = 0;
  double high = 0;
  double p_above = 1;  ///< one-sided p-value of a mean this high if the true mean is 0, in (0, 1]
  double p_below = 1;  ///< the same for a mean this low
};

/// Studentised bootstrap (bootstrap-t; Efron and Tibshirani 1993, 12.5) of the mean m of n values
/// with standard deviation s, se = s / sqrt(n): over resamples (*) with replacement
///   t* = (m* - m) / se*,   low = m - se q(1 - tail),   high = m - se q(tail),
///   p_above = (1 + #{t* >= m / se}) / (1 + resamples)
/// with q the quantiles of t*. A resample without spread counts as infinitely far on its side.
/// Where all values are equal the interval is that value, and p is the smallest value that the
/// number of resamples permits (1 for a mean of 0). Contract: at least kLeastForBootstrap finite
/// values.
[[nodiscard]] BootstrapMean bootstrap_mean(std::span<const double> values,
                                           const ResampleOptions& options = {});

/// A ratio with its confidence interval.
struct BootstrapRatio {
  double ratio = 1;
  double low = 1;
  double high = 1;
};

/// The median of of[i] / to[i] and its percentile bootstrap interval, where of[i] and to[i] were
/// measured directly after each other: a slow phase of the machine affects both values of a pair,
/// and a change of its speed affects one pair only. Contract: equally many of each, at least one;
/// all are finite and above 0.
[[nodiscard]] BootstrapRatio bootstrap_paired_ratio(std::span<const double> of,
                                                    std::span<const double> to,
                                                    const ResampleOptions& options = {});

}  // namespace saccade
