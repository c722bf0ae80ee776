#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "eval/sweep/result/results.h"

namespace saccade {

struct SweepChart {
  std::string file;  ///< in the folder of the sweep
  std::string caption;
};

/// Draws what a sweep varies: for each axis of numbers a picture of its metrics over it, a line for
/// each dataset (and for each value of what else is varied); where there is no such axis, bars for
/// each configuration, variant and value. Nothing where a dataset has one row only.
[[nodiscard]] std::vector<SweepChart> write_charts(const SweepResults& results,
                                                     const std::filesystem::path& folder);

}  // namespace saccade
