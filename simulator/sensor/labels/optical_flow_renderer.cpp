#include "simulator/sensor/labels/optical_flow_renderer.h"

#include <algorithm>
#include <array>
#include <optional>

#include "core/process/parallel.h"
#include "simulator/sensor/rays/tile_trace.h"

namespace saccade {
namespace {

/// What is nearer by a smaller fraction of the distance is the surface itself.
constexpr double kSameSurface = 1e-4;
/// Points nearer to the plane of the camera than this fraction of their distance from it are outside
/// of every image.
constexpr double kLeastDepth = 1e-6;

/// The point or, for the background, the direction that a ray meets, as the second camera sees it.
Eigen::Vector3d in_other_camera(const Scene& scene, const Ray& ray, TriangleId triangle,
                                const StampedPose& to) {
  const Eigen::Matrix3d camera_from_world = to.world_from_camera.rotation_matrix().transpose();
  if (triangle == kNothing) return camera_from_world * ray.direction;
  return camera_from_world *
         (scene.carried_point(ray, triangle, to.t_s) - to.world_from_camera.translation());
}

/// Where a point is in a distorted image; nullopt behind the camera, and so far outside that the
/// lens model folds over.
std::optional<Eigen::Vector2d> pixel_of(const PinholeCamera& camera, const Eigen::Vector3d& point) {
  if (!(point.z() > kLeastDepth * point.norm())) return std::nullopt;
  const Eigen::Vector2d ideal = camera.project(point);
  if (!camera.is_distorted()) return ideal;
  constexpr double kFolded_px = 0.01;
  const Eigen::Vector2d pixel = camera.distort(ideal);
  if (!((camera.undistort(pixel) - ideal).norm() < kFolded_px)) return std::nullopt;
  return pixel;
}

bool is_in_image(const PinholeCamera& camera, const Eigen::Vector2d& pixel) {
  return pixel.x() >= -0.5 && pixel.y() >= -0.5 && pixel.x() < camera.width - 0.5 &&
         pixel.y() < camera.height - 0.5;
}

/// The flow of one tile's pixels.
class TileFlow {
 public:
  TileFlow(const Scene& scene, const PinholeCamera& camera, const StampedPose& to)
      : scene_(scene), camera_(camera), to_(to) {}

  void add(const Ray& ray, TriangleId triangle) {
    Point& point = points_[count_++];
    point.triangle = triangle;
    point.place = in_other_camera(scene_, ray, triangle, to_);
    point.pixel = pixel_of(camera_, point.place);
  }

  void store(const Tile& tile, OpticalFlow& flow) const {
    const std::array<Covisibility, kTilePixels> seen = covisibilities();
    for (std::size_t i = 0; i < count_; ++i) {
      const int x = tile.x(i);
      const int y = tile.y(i);
      flow.covisibility(x, y) = static_cast<std::uint8_t>(seen[i]);
      if (!points_[i].pixel) continue;
      flow.is_valid(x, y) = 1;
      flow.u(x, y) = static_cast<float>(points_[i].pixel->x() - x);
      flow.v(x, y) = static_cast<float>(points_[i].pixel->y() - y);
    }
  }

 private:
  struct Point {
    TriangleId triangle = kNothing;
    Eigen::Vector3d place = Eigen::Vector3d::Zero();  ///< in the other camera's frame
    std::optional<Eigen::Vector2d> pixel;
  };

  [[nodiscard]] std::array<Covisibility, kTilePixels> covisibilities() const {
    std::array<Covisibility, kTilePixels> seen;
    std::array<Ray, kTilePixels> rays;
    std::array<TriangleId, kTilePixels> found;
    const Eigen::Matrix3d rotation = to_.world_from_camera.rotation_matrix();
    for (std::size_t i = 0; i < count_; ++i) {
      const Eigen::Vector3d& place = points_[i].place;
      const bool is_before = points_[i].pixel.has_value();
      const Eigen::Vector3d direction =
          is_before ? Eigen::Vector3d(place / place.z()) : Eigen::Vector3d::UnitZ();
      rays[i] = {to_.world_from_camera.translation(), rotation * direction, to_.t_s};
    }
    scene_.visible({rays.data(), count_}, {found.data(), count_});
    for (std::size_t i = 0; i < count_; ++i) {
      if (!points_[i].pixel || !is_in_image(camera_, *points_[i].pixel))
        seen[i] = Covisibility::kOutside;
      else
        seen[i] = is_hidden(points_[i], rays[i], found[i]) ? Covisibility::kOccluded
                                                           : Covisibility::kVisible;
    }
    return seen;
  }

  [[nodiscard]] bool is_hidden(const Point& point, const Ray& ray, TriangleId found) const {
    if (found == kNothing || found == point.triangle) return false;
    if (point.triangle == kNothing) return true;
    return scene_.sample_surface(ray, found).distance < (1 - kSameSurface) * point.place.z();
  }

  const Scene& scene_;
  const PinholeCamera& camera_;
  const StampedPose& to_;
  std::size_t count_ = 0;
  std::array<Point, kTilePixels> points_;
};

}  // namespace

OpticalFlow OpticalFlowRenderer::flow(const StampedPose& from, const StampedPose& to) const {
  const int width = rays_.camera().width;
  const int height = rays_.camera().height;
  OpticalFlow flow{ImageF(width, height), ImageF(width, height), ImageU8(width, height),
                   ImageU8(width, height)};
  const auto render = [&](std::size_t index) {
    TileFlow tile(scene_, rays_.camera(), to);
    trace_tile(
        scene_, rays_.rays(index), from,
        [&](std::size_t /*i*/, const Ray& ray, TriangleId triangle) { tile.add(ray, triangle); });
    tile.store(rays_.tile(index), flow);
  };
  parallel_for(rays_.tile_count(), render, kTilesPerTask);
  return flow;
}

}  // namespace saccade
