#pragma once

#include <span>
#include <string>

#include "eval/report/page_chart.h"
#include "eval/report/run_data.h"

namespace saccade {

/// What the page's script draws, as JSON that is safe inside a <script> element:
///   {"runs": [{"id", "name", "times", "truth": [[x, y, z], ...], "estimate",
///              "gaps": [[from, to], ...], "cloud": {"origin", "unit", "points"},
///              "series": {name: {"label", "unit", "t", "v", "mean"}}}],
///    "charts": [...]}   as chart_json() has them
/// Long series keep the smallest and the largest value of every stretch, so that no peak is lost.
/// Clouds are thinned out.
[[nodiscard]] std::string page_data(std::span<const RunData> runs,
                                    std::span<const PageChart> charts);

}  // namespace saccade
