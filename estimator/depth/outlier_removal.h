#pragma once

#include <vector>

#include "core/camera.h"
#include "core/config/fields.h"
#include "estimator/depth/depth_estimator.h"

namespace saccade {

struct OutlierOptions {
  double radius_ratio = 0.035;
  int min_neighbours = 2;
};

void describe(config::Fields& fields, OutlierOptions& options);

/// Radius outlier removal (thesis 5.3): drops every point with too few others around it in space.
/// The radius grows with the distance, as the spacing of pixels does. `camera` is undistorted.
[[nodiscard]] std::vector<EdgePoint> without_outliers(const std::vector<EdgePoint>& points,
                                                      const PinholeCamera& camera,
                                                      const OutlierOptions& options);

}  // namespace saccade
