#include "estimator/depth/outlier_removal.h"

#include <cstddef>

namespace saccade {

void describe(config::Fields& fields, OutlierOptions& options) {
  fields
      .value("radius_ratio", options.radius_ratio,
             "Radius of the neighbourhood of a point in space, divided by the point's depth.")
      .above(0);
  fields
      .value("min_neighbours", options.min_neighbours,
             "Points with fewer other points in their neighbourhood are dropped; 0 disables the "
             "outlier removal.")
      .range(0, 1000);
}

std::vector<EdgePoint> without_outliers(const std::vector<EdgePoint>& points,
                                        const PinholeCamera& camera,
                                        const OutlierOptions& options) {
  std::vector<Eigen::Vector3d> positions;
  positions.reserve(points.size());
  for (const EdgePoint& point : points)
    positions.emplace_back(camera.ray({point.x_px, point.y_px}) /
                           static_cast<double>(point.inverse_depth));
  std::vector<EdgePoint> kept;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double radius = options.radius_ratio * positions[i].z();
    int neighbours = 0;
    for (std::size_t j = 0; j < points.size() && neighbours < options.min_neighbours; ++j)
      if (j != i && (positions[j] - positions[i]).squaredNorm() <= radius * radius) ++neighbours;
    if (neighbours >= options.min_neighbours) kept.push_back(points[i]);
  }
  return kept;
}

}  // namespace saccade
