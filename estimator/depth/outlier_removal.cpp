#include "estimator/depth/outlier_removal.h"

#include <cstddef>

namespace saccade {

std::vector<EdgePoint> without_outliers(const std::vector<EdgePoint>& points,
                                        const PinholeCamera& camera, double radius_ratio,
                                        int min_neighbours) {
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
