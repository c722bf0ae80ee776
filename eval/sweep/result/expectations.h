#pragma once

#include <optional>
#include <string>
#include <vector>

#include "eval/sweep/result/results.h"

namespace saccade {

/// What became of an expected figure on one dataset.
struct ExpectationResult {
  const ExpectedMetric* figure;
  std::string dataset;
  std::optional<double> value;  ///< of all seeds; none where nothing was measured
  bool met = false;             ///< never without a value, nor where a run of a seed failed
};

/// One verdict for each expected figure, dataset and, where the sweep varies more, each row of it.
[[nodiscard]] std::vector<ExpectationResult> check_expectations(const SweepResults& results);

}  // namespace saccade
