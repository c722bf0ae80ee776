#pragma once

#include <span>

#include <Eigen/Core>

#include "core/image.h"
#include "eval/picture/canvas/colour.h"

namespace saccade {

/// Positions in 3-D seen obliquely from above (world up is +z), equally scaled on all axes: the
/// truth as a broad line, the estimate as a thin one over it, in a box with its side lengths in
/// metres. Either may be empty.
[[nodiscard]] ImageRgb8 draw_trajectory(std::span<const Eigen::Vector3d> truth,
                                        std::span<const Eigen::Vector3d> estimate, int width,
                                        int height, const Theme& theme);

}  // namespace saccade
