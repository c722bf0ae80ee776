#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/image.h"

namespace saccade {

/// The keypoints of an event frame (thesis section 5.5): one per cell of a regular grid whose mean
/// reaches `min_weight` times that of the image, at the cell's centre of mass [px]. `cell_px`: side s
/// of a cell. Row by row; cells that the border cuts are left out, an empty frame has none. `frame`:
/// weights >= 0.
[[nodiscard]] std::vector<Eigen::Vector2f> find_keypoints(const ImageF& frame, int cell_px,
                                                          double min_weight);

}  // namespace saccade
