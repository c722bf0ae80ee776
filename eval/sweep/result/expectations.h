#pragma once

#include <optional>
#include <string>
#include <vector>

#include "eval/sweep/result/results.h"

namespace saccade {

/// An expected metric and its value on one dataset.
struct ExpectationResult {
  const ExpectedMetric* expected;
  std::string dataset;
  std::optional<double> value;  ///< over all seeds; nullopt where nothing was measured
  bool met = false;             ///< false without a value, and where the run of a seed failed
};

/// One result per expected metric and group of its configuration.
[[nodiscard]] std::vector<ExpectationResult> check_expectations(const SweepResults& results);

}  // namespace saccade
