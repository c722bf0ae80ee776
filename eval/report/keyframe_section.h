#pragma once

#include <string>

#include "eval/report/run_data.h"

namespace saccade {

/// The keyframes of an odometry run as HTML: a table of when each was made and taken, what it holds
/// and how far the pose jumped; and their depth maps in order (thesis figs. 8.18, 8.19). Empty
/// where the run has none.
[[nodiscard]] std::string keyframe_section(const RunData& data);

}  // namespace saccade
