#pragma once

#include <string>

#include "eval/report/run_data.h"

namespace saccade {

/// The keyframes of an odometry run as HTML: a table of when each was made and taken, what it holds
/// and how far the pose jumped; the path from above with the keyframes on it; depth maps and images
/// of at most eight, evenly chosen (thesis figs. 8.18, 8.19). Empty where the run has none or its
/// dataset is gone.
[[nodiscard]] std::string keyframe_section(const RunData& data);

}  // namespace saccade
