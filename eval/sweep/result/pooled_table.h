#pragma once

#include <string>

#include "eval/sweep/result/results.h"

namespace saccade {

/// The part of a sweep's page that pools its runs over datasets and seeds, a table for each module
/// with a row per configuration, variant and grid point: the share that succeeded with Wilson's
/// interval; what was told of being lost; mean, median and 90th percentile of the errors over the
/// runs. Of losses seconds are added before they are divided, so that a run without a loss, of which
/// no ratio is known, counts with its time, and a short one for no more than a long one. Empty where
/// the sweep has one dataset, or nothing runs.
[[nodiscard]] std::string pooled_table(const SweepResults& results);

}  // namespace saccade
