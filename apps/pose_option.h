#pragma once

#include <string>

#include "core/rigid3.h"

namespace saccade {

/// "x y z qx qy qz qw": seven finite numbers, the last four of length 1 (within 1e-3). Otherwise an
/// InputError at `option` with the character and what would be right.
[[nodiscard]] Rigid3 parse_pose(const std::string& text, const std::string& option);

}  // namespace saccade
