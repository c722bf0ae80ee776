#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/image.h"

namespace saccade {

struct KeypointOptions {
  int cell_px = 3;          ///< s: side of a cell of the grid
  double min_weight = 0.3;  ///< of a cell's mean, in units of the whole image's mean
};

/// The keypoints of an event frame (thesis 5.5): one per cell of a regular grid whose mean reaches
/// `min_weight` times that of the image, at the cell's centre of mass [px]. Row by row; cells that
/// the border cuts are left out, an empty frame has none. `frame`: weights >= 0.
[[nodiscard]] std::vector<Eigen::Vector2f> find_keypoints(const ImageF& frame,
                                                          const KeypointOptions& options);

}  // namespace saccade
