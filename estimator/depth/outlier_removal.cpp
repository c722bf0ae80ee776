#include "estimator/depth/outlier_removal.h"

#include <cmath>
#include <cstddef>

namespace saccade {

std::vector<EdgeDepth> without_outliers(const std::vector<EdgeDepth>& points,
                                        const PinholeCamera& camera,
                                        const OutlierOptions& options) {
  std::vector<Eigen::Vector3d> positions;
  positions.reserve(points.size());
  for (const EdgeDepth& point : points)
    positions.emplace_back(camera.ray({point.x_px, point.y_px}) /
                           static_cast<double>(point.inverse_depth));
  std::vector<EdgeDepth> kept;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double radius = options.radius * positions[i].z();
    int neighbours = 0;
    for (std::size_t j = 0; j < points.size() && neighbours < options.neighbours; ++j)
      if (j != i && (positions[j] - positions[i]).squaredNorm() <= radius * radius) ++neighbours;
    if (neighbours >= options.neighbours) kept.push_back(points[i]);
  }
  return kept;
}

}  // namespace saccade
