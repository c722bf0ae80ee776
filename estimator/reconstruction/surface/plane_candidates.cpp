#include "estimator/reconstruction/surface/plane_candidates.h"

#include <algorithm>
#include <cstddef>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "estimator/depth/rays/local_planes.h"

namespace saccade {
namespace {

constexpr double kRadius_px = 10;  ///< of the neighbours of an anchor
constexpr float kOutlier = 3;      ///< sigmas from which on an anchor is no inlier
constexpr float kModelError = 0.002F;
constexpr int kRefits = 3;
// A sample of the anchors and of their planes is enough to find planes with many inliers.
constexpr std::size_t kMostAnchors = 3000;
constexpr std::size_t kMostTried = 300;
constexpr std::size_t kMostPlanes = 24;
constexpr float kLeastSupport = 20;  ///< anchors of the sample

float variance_of(const SurfaceAnchor& anchor) {
  return anchor.inverse_depth * anchor.inverse_depth *
         (anchor.relative_sigma * anchor.relative_sigma + kModelError * kModelError);
}

/// 1 on the plane, 0 from kOutlier sigmas on.
float agreement(const SurfaceAnchor& anchor, const InverseDepthPlane& plane) {
  const float error = plane.inverse_depth(anchor.x_px, anchor.y_px) - anchor.inverse_depth;
  return std::max(0.F, 1 - error * error / (kOutlier * kOutlier * variance_of(anchor)));
}

InverseDepthPlane refitted(std::span<const SurfaceAnchor> anchors, const InverseDepthPlane& plane) {
  Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  for (const SurfaceAnchor& anchor : anchors) {
    const float ratio = agreement(anchor, plane);
    if (!(ratio > 0)) continue;
    const auto weight = static_cast<double>(ratio / variance_of(anchor));
    const Eigen::Vector3d row(1, static_cast<double>(anchor.x_px),
                              static_cast<double>(anchor.y_px));
    a += weight * row * row.transpose();
    b += weight * static_cast<double>(anchor.inverse_depth) * row;
  }
  const Eigen::Vector3f solution = Eigen::LDLT<Eigen::Matrix3d>(a).solve(b).cast<float>();
  if (!solution.allFinite()) return plane;
  return {solution.x(), solution.y(), solution.z()};
}

}  // namespace

std::vector<InverseDepthPlane> planes_around(std::span<const SurfaceAnchor> anchors) {
  std::vector<EdgePoint> points;
  points.reserve(anchors.size());
  for (const SurfaceAnchor& a : anchors)
    points.push_back({a.x_px, a.y_px, a.inverse_depth, a.relative_sigma * a.inverse_depth});
  PlaneOptions options;
  options.radius_px = kRadius_px;
  LocalPlanes local(points, options);
  std::vector<InverseDepthPlane> planes;
  planes.reserve(points.size());
  for (const EdgePoint& point : points) {
    const LocalPlane plane = local.fit(point);
    planes.push_back(
        {plane.inverse_depth - plane.slope.x() * point.x_px - plane.slope.y() * point.y_px,
         plane.slope.x(), plane.slope.y()});
  }
  return planes;
}

std::vector<InverseDepthPlane> common_planes(std::span<const SurfaceAnchor> anchors,
                                             std::span<const InverseDepthPlane> local) {
  std::vector<SurfaceAnchor> remaining;
  const std::size_t every = std::max<std::size_t>(1, anchors.size() / kMostAnchors);
  for (std::size_t k = 0; k < anchors.size(); k += every) remaining.push_back(anchors[k]);
  std::vector<InverseDepthPlane> found;
  const std::size_t step = std::max<std::size_t>(1, local.size() / kMostTried);
  while (found.size() < kMostPlanes) {
    float most = 0;
    InverseDepthPlane best;
    for (std::size_t k = 0; k < local.size(); k += step) {
      float support = 0;
      for (const SurfaceAnchor& anchor : remaining) support += agreement(anchor, local[k]);
      if (support <= most) continue;
      most = support;
      best = local[k];
    }
    if (most < kLeastSupport) break;
    for (int i = 0; i < kRefits; ++i) best = refitted(remaining, best);
    const std::size_t before = remaining.size();
    std::erase_if(remaining,
                  [&](const SurfaceAnchor& anchor) { return agreement(anchor, best) > 0; });
    if (remaining.size() == before) break;
    found.push_back(best);
  }
  return found;
}

}  // namespace saccade
