#pragma once

#include <span>
#include <string>

#include "eval/report/run_data.h"

namespace saccade {

/// What the page's script draws, as JSON that is safe inside a <script> element:
///   {"runs": [{"id", "span": [t0, t1], "times", "truth": [[x, y, z], ...], "estimate",
///              "gaps": [[from, to], ...], "series": {name: {"label", "unit", "t", "v", "mean",
///              "max"}}}]}
/// Long series keep the smallest and the largest value of every stretch, so that no peak is lost.
[[nodiscard]] std::string run_series(std::span<const RunData> runs);

}  // namespace saccade
