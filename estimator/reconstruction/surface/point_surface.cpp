#include "estimator/reconstruction/surface/point_surface.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "estimator/reconstruction/surface/plane_candidates.h"
#include "estimator/reconstruction/surface/plane_labels.h"

namespace saccade {
namespace {

constexpr double kLeastSigma = 0.001;  ///< of a point's relative depth
constexpr int kCell_px = 8;            ///< its nearest and its farthest plane are tried
constexpr int kReach_px = 24;          ///< ... on the pixels within this distance

std::vector<SurfaceAnchor> anchors_of(std::span<const SurfacePoint> points,
                                      const PinholeCamera& camera) {
  std::vector<SurfaceAnchor> anchors;
  for (const SurfacePoint& point : points) {
    if (!(point.position.z() > 0)) continue;
    const Eigen::Vector2d pixel = camera.project(point.position);
    if (!camera.contains(pixel)) continue;
    anchors.push_back({static_cast<float>(pixel.x()), static_cast<float>(pixel.y()),
                       static_cast<float>(1 / point.position.z()),
                       static_cast<float>(std::max(point.relative_sigma, kLeastSigma))});
  }
  return anchors;
}

constexpr int kNone = -1;

/// Indices of the nearest and the farthest anchor of each cell of the image.
Image<std::pair<int, int>> extreme_anchors(std::span<const SurfaceAnchor> anchors,
                                           const PinholeCamera& camera) {
  Image<std::pair<int, int>> cells(camera.width / kCell_px + 1, camera.height / kCell_px + 1,
                                   {kNone, kNone});
  const auto index = [](float px, int count) {
    return std::clamp(static_cast<int>(px) / kCell_px, 0, count - 1);
  };
  const auto of = [&](int k) { return anchors[static_cast<std::size_t>(k)].inverse_depth; };
  for (int k = 0; k < static_cast<int>(anchors.size()); ++k) {
    const SurfaceAnchor& anchor = anchors[static_cast<std::size_t>(k)];
    auto& [near, far] =
        cells(index(anchor.x_px, cells.width()), index(anchor.y_px, cells.height()));
    if (near == kNone || of(k) > of(near)) near = k;
    if (far == kNone || of(k) < of(far)) far = k;
  }
  return cells;
}

void expand_locally(PlaneLabels& labels, const Image<std::pair<int, int>>& cells,
                    std::span<const InverseDepthPlane> planes) {
  for (int row = 0; row < cells.height(); ++row)
    for (int column = 0; column < cells.width(); ++column) {
      const auto [near, far] = cells(column, row);
      if (near == kNone) continue;
      const int x = column * kCell_px + kCell_px / 2, y = row * kCell_px + kCell_px / 2;
      labels.expand_near(planes[static_cast<std::size_t>(near)], x, y, kReach_px);
      if (far != near) labels.expand_near(planes[static_cast<std::size_t>(far)], x, y, kReach_px);
    }
}

/// The camera of squares of 2 x 2 pixels.
PinholeCamera halved(const PinholeCamera& camera) {
  PinholeCamera half = camera;
  half.width = (camera.width + 1) / 2;
  half.height = (camera.height + 1) / 2;
  half.fx /= 2;
  half.fy /= 2;
  half.cx = (camera.cx - 0.5) / 2;
  half.cy = (camera.cy - 0.5) / 2;
  return half;
}

/// Depth of the pixels between squares of 2 x 2: bilinear of those nearest squares that lie on the surface of the pixel's own.
float depth_between(const ImageF& depth, int x, int y) {
  constexpr float kSameSurface = 0.03F;  // relative, of squares beside each other
  const auto beside = [](int pixel, int count) {
    return std::clamp(pixel / 2 + (pixel % 2 == 0 ? -1 : 1), 0, count - 1);
  };
  const int u = x / 2, v = y / 2;
  const int next_u = beside(x, depth.width()), next_v = beside(y, depth.height());
  const float own = depth(u, v);
  const auto of = [&](int column, int row) {
    const float other = depth(column, row);
    return std::abs(other - own) <= kSameSurface * own ? other : own;
  };
  return (9 * own + 3 * (of(next_u, v) + of(u, next_v)) + of(next_u, next_v)) / 16;
}

}  // namespace

ImageF surface_through(std::span<const SurfacePoint> points, const PinholeCamera& camera) {
  const std::vector<SurfaceAnchor> anchors = anchors_of(points, camera);
  ImageF depth(camera.width, camera.height);
  if (anchors.empty()) return depth;
  const std::vector<InverseDepthPlane> local = planes_around(anchors);
  const std::vector<InverseDepthPlane> common = common_planes(anchors, local);
  PlaneLabels labels(camera.width, camera.height, anchors, local);
  const auto expand_everywhere = [&] {
    for (const InverseDepthPlane& plane : common) labels.expand(plane);
  };
  expand_everywhere();
  expand_locally(labels, extreme_anchors(anchors, camera), local);
  expand_everywhere();
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x) depth(x, y) = std::exp(-labels.log_inverse_depth(x, y));
  return depth;
}

ImageF coarse_surface_through(std::span<const SurfacePoint> points, const PinholeCamera& camera) {
  const ImageF coarse = surface_through(points, halved(camera));
  ImageF depth(camera.width, camera.height);
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x) depth(x, y) = depth_between(coarse, x, y);
  return depth;
}

}  // namespace saccade
