#include "estimator/edges/landmarks.h"

#include <algorithm>
#include <cmath>

namespace saccade {

ProjectedLandmarks::ProjectedLandmarks(std::span<const Landmark> landmarks,
                                       const Rigid3& view_from_world, const PinholeCamera& camera)
    : first_(camera.width, camera.height, kNone) {
  for (std::size_t i = 0; i < landmarks.size(); ++i) {
    const Landmark& landmark = landmarks[i];
    const Eigen::Vector3d point = view_from_world * landmark.in_world;
    if (!(point.z() > 0)) continue;
    const Eigen::Vector2d pixel = camera.project(point);
    if (!camera.contains(pixel)) continue;
    int& first =
        first_(static_cast<int>(std::lround(pixel.x())), static_cast<int>(std::lround(pixel.y())));
    next_.push_back(first);
    first = static_cast<int>(projections_.size());
    projections_.push_back({pixel, 1 / point.z(), landmark.sigma / point.z(), i});
  }
}

const ProjectedLandmarks::Projection* ProjectedLandmarks::nearest(const Edgel& edge,
                                                                  double reach_px,
                                                                  double tolerance) const {
  const Eigen::Vector2d at = edge.pixel.cast<double>();
  const auto inverse_depth = static_cast<double>(edge.inverse_depth);
  const auto bound = [&](double value, int size) {
    return std::clamp(static_cast<int>(std::lround(value)), 0, size - 1);
  };
  const int right = bound(at.x() + reach_px, first_.width());
  const int bottom = bound(at.y() + reach_px, first_.height());
  const Projection* nearest = nullptr;
  double distance_px = reach_px;
  for (int y = bound(at.y() - reach_px, first_.height()); y <= bottom; ++y)
    for (int x = bound(at.x() - reach_px, first_.width()); x <= right; ++x)
      for (int i = first_(x, y); i != kNone; i = next_[static_cast<std::size_t>(i)]) {
        const Projection& candidate = projections_[static_cast<std::size_t>(i)];
        if (std::abs(candidate.inverse_depth - inverse_depth) > tolerance * inverse_depth) continue;
        const double away_px = (candidate.pixel - at).norm();
        if (away_px >= distance_px) continue;
        distance_px = away_px;
        nearest = &candidate;
      }
  return nearest;
}

}  // namespace saccade
