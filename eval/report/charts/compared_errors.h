#pragma once

#include <span>
#include <vector>

#include "eval/report/charts/page_chart.h"
#include "eval/report/run_data.h"

namespace saccade {

/// The errors of several methods on one sequence, in a chart for each: position and rotation over
/// time (of a method's first run) and the fraction of the time, or of the points with depth, that is
/// below an error (over all runs of a method). A chart that would show fewer than two methods is
/// left out.
[[nodiscard]] std::vector<PageChart> compared_errors(std::span<const RunData* const> runs,
                                                     const MethodStyles& styles);

}  // namespace saccade
