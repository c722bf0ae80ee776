#pragma once

#include <vector>

#include "core/camera.h"
#include "estimator/depth/depth_estimator.h"

namespace saccade {

struct OutlierOptions {
  double radius = 0.035;  ///< of the neighbourhood, as a share of the point's own depth
  int neighbours = 2;     ///< least number of other points within it; 0 keeps everything
};

/// Radius outlier removal (thesis 5.3): drops every point with too few others around it in space.
/// The radius grows with the distance, as the spacing of pixels does. `camera` is undistorted.
[[nodiscard]] std::vector<EdgeDepth> without_outliers(const std::vector<EdgeDepth>& points,
                                                      const PinholeCamera& camera,
                                                      const OutlierOptions& options);

}  // namespace saccade
