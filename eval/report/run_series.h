#pragma once

#include <span>
#include <string>

#include "eval/report/run_data.h"

namespace saccade {

/// What the page's script draws, as JSON that is safe inside a <script> element:
///   {"runs": [{"id", "name", "dataset", "span": [t0, t1], "times", "truth": [[x, y, z], ...],
///              "estimate", "gaps": [[from, to], ...], "cloud": {"origin", "unit", "points"},
///              "series": {name: {"label", "unit", "t", "v", "mean", "max", "quantiles"}}}]}
/// Long series keep the smallest and the largest value of every stretch, so that no peak is lost;
/// their quantiles at 0, 1, ..., 100 % are those of all values. Clouds are thinned out.
[[nodiscard]] std::string run_series(std::span<const RunData> runs);

}  // namespace saccade
