#pragma once

#include <cstddef>
#include <span>

namespace saccade::testing {

/// Overlapping Allan deviation (IEEE Std 952) of samples `dt_s` apart at tau = m dt, from their
/// integral theta:
///   sigma^2(tau) = sum_k (theta_{k+2m} - 2 theta_{k+m} + theta_k)^2 / (2 tau^2 (N - 2m + 1))
/// over N samples; 1 <= m <= N / 2.
[[nodiscard]] double allan_deviation(std::span<const double> samples, double dt_s, std::size_t m);

/// Slope of the least-squares line through (log x, log y).
[[nodiscard]] double log_slope(std::span<const double> x, std::span<const double> y);

}  // namespace saccade::testing
