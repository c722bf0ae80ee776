#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>

#include "core/check.h"
#include "eval/metrics/metrics.h"

namespace saccade {

/// The four numbers of thesis table 8.2 over N samples, sums in the order of the samples:
///   mean = sum e / N,  sigma = sqrt(sum (e - mean)^2 / N),  rmse = sqrt(sum e^2 / N).
struct Statistics {
  double mean = 0;
  double sigma = 0;  ///< of the population: divided by N, not N - 1
  double max = 0;
  double rmse = 0;
};

/// `samples`: at least one.
[[nodiscard]] inline Statistics statistics_of(std::span<const double> samples) {
  SACCADE_CHECK(!samples.empty());
  const double n = static_cast<double>(samples.size());
  Statistics result;
  double sum = 0;
  double sum_of_squares = 0;
  result.max = samples.front();
  for (const double sample : samples) {
    sum += sample;
    sum_of_squares += sample * sample;
    result.max = std::max(result.max, sample);
  }
  result.mean = sum / n;
  result.rmse = std::sqrt(sum_of_squares / n);
  // A second pass: mean of squares minus square of the mean loses small sigmas to cancellation.
  double squared_deviations = 0;
  for (const double sample : samples)
    squared_deviations += (sample - result.mean) * (sample - result.mean);
  result.sigma = std::sqrt(squared_deviations / n);
  return result;
}

/// 97.5 % quantile of Student's t with `freedom` >= 1 degrees of freedom, to 0.003: the 95 %
/// interval of a mean of n values is mean +- student_95(n - 1) s / sqrt(n).
[[nodiscard]] inline double student_95(std::size_t freedom) {
  SACCADE_CHECK(freedom >= 1);
  constexpr std::array kFirst{12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262};
  if (freedom <= kFirst.size()) return kFirst[freedom - 1];
  // Expansion about the normal distribution's quantile.
  const auto n = static_cast<double>(freedom);
  return 1.960 + 2.372 / n + 2.823 / (n * n);
}

/// Wilson's 95 % interval of a probability of which `successes` of `trials` >= 1 independent trials
/// tell (Wilson, JASA 22, 1927): the p for which |successes / trials - p| is at most 1.96 standard
/// deviations sqrt(p (1 - p) / trials). Unlike mean +- deviation it is honest at 0 and 1.
struct ProportionInterval {
  double low = 0;
  double high = 1;
};
[[nodiscard]] inline ProportionInterval wilson_95(double successes, double trials) {
  SACCADE_CHECK(trials >= 1 && successes >= 0 && successes <= trials);
  constexpr double kZ = 1.959964;
  const double p = successes / trials;
  const double middle = (p + kZ * kZ / (2 * trials)) / (1 + kZ * kZ / trials);
  const double half = kZ / (1 + kZ * kZ / trials) *
                      std::sqrt(p * (1 - p) / trials + kZ * kZ / (4 * trials * trials));
  // Rounding would leave a little at the ends.
  return {successes == 0 ? 0 : middle - half, successes == trials ? 1 : middle + half};
}

/// Sets `key`.{mean,sigma,max,rmse}; all null where `samples` is empty.
inline void set_statistics(Metrics& metrics, const std::string& key,
                           std::span<const double> samples) {
  std::optional<Statistics> s;
  if (!samples.empty()) s = statistics_of(samples);
  const auto set = [&](const char* name, double Statistics::*member) {
    metrics.set(key + "." + name, s ? std::optional(*s.*member) : std::nullopt);
  };
  set("mean", &Statistics::mean);
  set("sigma", &Statistics::sigma);
  set("max", &Statistics::max);
  set("rmse", &Statistics::rmse);
}

}  // namespace saccade
