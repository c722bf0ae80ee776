#pragma once

#include <cstddef>
#include <span>
#include <string>

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
[[nodiscard]] Statistics statistics_of(std::span<const double> samples);

/// 97.5 % quantile of Student's t with `freedom` >= 1 degrees of freedom, to 0.003: the 95 %
/// interval of a mean of n values is mean +- student_95(n - 1) s / sqrt(n).
[[nodiscard]] double student_95(std::size_t freedom);

/// Sets `key`.{mean,sigma,max,rmse}; all null where `samples` is empty.
void set_statistics(Metrics& metrics, const std::string& key, std::span<const double> samples);

}  // namespace saccade
