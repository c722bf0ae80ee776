#pragma once

#include <cstddef>
#include <vector>

#include "core/camera.h"
#include "estimator/depth/depth_estimator.h"

namespace saccade {

/// Radius outlier removal (thesis 5.3): drops every point with fewer than `min_neighbours` others
/// around it in space. The radius is `radius_ratio` times the depth, as the spacing of pixels grows. `camera` is undistorted.
[[nodiscard]] inline std::vector<EdgePoint> without_outliers(const std::vector<EdgePoint>& points,
                                                             const PinholeCamera& camera,
                                                             double radius_ratio = 0.035,
                                                             int min_neighbours = 2) {
  std::vector<Eigen::Vector3d> positions;
  positions.reserve(points.size());
  for (const EdgePoint& point : points)
    positions.emplace_back(camera.ray({point.x_px, point.y_px}) /
                           static_cast<double>(point.inverse_depth));
  std::vector<EdgePoint> kept;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double radius = radius_ratio * positions[i].z();
    int neighbours = 0;
    for (std::size_t j = 0; j < points.size() && neighbours < min_neighbours; ++j)
      if (j != i && (positions[j] - positions[i]).squaredNorm() <= radius * radius) ++neighbours;
    if (neighbours >= min_neighbours) kept.push_back(points[i]);
  }
  return kept;
}

}  // namespace saccade
