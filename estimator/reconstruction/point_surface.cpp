#include "estimator/reconstruction/point_surface.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "estimator/reconstruction/plane_candidates.h"

namespace saccade {
namespace {

constexpr double kLeastSigma = 0.001;  ///< of a point's relative depth
constexpr int kCell_px = 8;            ///< the nearest and the farthest plane in it are offered
constexpr int kReach_px = 24;          ///< ... to the pixels so far around it

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

/// The cells of an image, each with its nearest and its farthest anchor.
class AnchorCells {
 public:
  static constexpr int kNone = -1;
  struct Cell {
    int near = kNone, far = kNone;
  };

  AnchorCells(std::span<const SurfaceAnchor> anchors, const PinholeCamera& camera)
      : cells_(camera.width / kCell_px + 1, camera.height / kCell_px + 1) {
    const auto of = [&](int k) { return anchors[static_cast<std::size_t>(k)].inverse_depth; };
    for (int k = 0; k < static_cast<int>(anchors.size()); ++k) {
      const SurfaceAnchor& anchor = anchors[static_cast<std::size_t>(k)];
      Cell& cell = cells_(index(anchor.x_px, cells_.width()), index(anchor.y_px, cells_.height()));
      if (cell.near == kNone || of(k) > of(cell.near)) cell.near = k;
      if (cell.far == kNone || of(k) < of(cell.far)) cell.far = k;
    }
  }

  [[nodiscard]] const Image<Cell>& cells() const { return cells_; }

 private:
  static int index(float px, int cells) {
    return std::clamp(static_cast<int>(px) / kCell_px, 0, cells - 1);
  }
  Image<Cell> cells_;
};

void expand_locally(PlaneLabels& labels, const Image<AnchorCells::Cell>& cells,
                    std::span<const ImagePlane> planes) {
  for (int row = 0; row < cells.height(); ++row)
    for (int column = 0; column < cells.width(); ++column) {
      const auto [near, far] = cells(column, row);
      if (near == AnchorCells::kNone) continue;
      const int x = column * kCell_px + kCell_px / 2, y = row * kCell_px + kCell_px / 2;
      labels.expand_near(planes[static_cast<std::size_t>(near)], x, y, kReach_px);
      if (far != near) labels.expand_near(planes[static_cast<std::size_t>(far)], x, y, kReach_px);
    }
}

}  // namespace

ImageF surface_through(std::span<const SurfacePoint> points, const PinholeCamera& camera,
                       const PlaneLabelOptions& options) {
  const std::vector<SurfaceAnchor> anchors = anchors_of(points, camera);
  ImageF depth(camera.width, camera.height);
  if (anchors.empty()) return depth;
  const std::vector<ImagePlane> local = planes_around(anchors);
  const std::vector<ImagePlane> common = common_planes(anchors, local);
  PlaneLabels labels(camera.width, camera.height, anchors, local, options);
  const auto expand_everywhere = [&] {
    for (const ImagePlane& plane : common) labels.expand(plane);
  };
  expand_everywhere();
  expand_locally(labels, AnchorCells(anchors, camera).cells(), local);
  expand_everywhere();
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x) depth(x, y) = std::exp(-labels.log_inverse_depth(x, y));
  return depth;
}

}  // namespace saccade
