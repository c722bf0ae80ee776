#pragma once

#include <string>

#include "eval/report/run_data.h"

namespace saccade {

/// The depth of a run as HTML: scores, a table of its views, estimated depth, truth and errors of
/// the view in the middle and of the worst (thesis figs. 8.9-8.11), the cloud from above, its
/// planes. Empty where the run has none or its dataset is gone.
[[nodiscard]] std::string depth_section(const RunData& data);

}  // namespace saccade
