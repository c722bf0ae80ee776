#pragma once

#include <vector>

#include "core/camera.h"
#include "estimator/depth/depth_estimator.h"

namespace saccade {

/// Radius outlier removal (thesis 5.3): drops every point with fewer than `min_neighbours` others
/// around it in space. The radius is `radius_ratio` (below 1, contract) times the depth, as the
/// spacing of pixels grows. `camera` is undistorted.
[[nodiscard]] std::vector<EdgePoint> without_outliers(const std::vector<EdgePoint>& points,
                                                      const PinholeCamera& camera,
                                                      double radius_ratio = 0.035,
                                                      int min_neighbours = 2);

}  // namespace saccade
