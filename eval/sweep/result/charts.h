#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "eval/sweep/result/results.h"

namespace saccade {

/// Draws the metrics over what the sweep varies: for each numeric axis of the grid a line chart
/// with a line per dataset (and per value of the other varied keys); without such an axis a bar
/// chart of all configurations, variants and values. Nothing where every dataset has a single row.
/// Returns the Markdown image of each chart.
[[nodiscard]] std::vector<std::string> write_charts(const SweepResults& results,
                                                    const std::filesystem::path& folder);

}  // namespace saccade
