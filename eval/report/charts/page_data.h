#pragma once

#include <span>
#include <string>

#include "eval/report/charts/page_chart.h"
#include "eval/report/run_data.h"

namespace saccade {

/// The charts of the page, chart_json() of each, as JSON that is safe inside a <script> element.
[[nodiscard]] std::string charts_data(std::span<const PageChart> charts);

/// What the page's script draws of a run, as such JSON:
///   {"id", "name", "times", "truth": [[x, y, z], ...], "estimate", "gaps": [[from, to], ...],
///    "cloud": {"origin", "unit", "points"},
///    "series": {name: {"label", "unit", "t", "v", "mean"}}}
/// Long series keep the smallest and the largest value of every stretch, so that no peak is lost.
/// Clouds are thinned out. Contract: the run has scored samples.
[[nodiscard]] std::string run_page_data(const RunData& data);

}  // namespace saccade
