#include "simulator/sensor/labels/label_renderer.h"

#include <algorithm>
#include <array>
#include <mutex>

#include "core/process/parallel.h"
#include "simulator/sensor/rays/tile_trace.h"

namespace saccade {
namespace {

/// Instances along one ray, each once.
using Met = std::vector<std::uint16_t>;

/// Rays go on so much behind a surface, as a fraction of its distance.
constexpr double kBehind = 1e-5;
/// More surfaces than this one behind another are not followed.
constexpr int kMostSurfaces = 256;

/// What lies along the rays of a tile, surface behind surface.
class TilePeeler {
 public:
  TilePeeler(const Scene& scene, std::span<const Eigen::Vector3d> directions,
             const StampedPose& pose)
      : scene_(scene), count_(directions.size()) {
    const Eigen::Matrix3d rotation = pose.world_from_camera.rotation_matrix();
    for (std::size_t k = 0; k < count_; ++k)
      rays_[k] = {pose.world_from_camera.translation(), rotation * directions[k], pose.t_s};
  }

  [[nodiscard]] std::span<const Met> peel() {
    for (int surface = 0; surface < kMostSurfaces && advance(); ++surface) {
    }
    return {met_.data(), count_};
  }

 private:
  /// To the next surface of every ray; false where none has one.
  bool advance() {
    std::array<TriangleId, kTilePixels> triangles;
    scene_.visible({rays_.data(), count_}, {triangles.data(), count_});
    bool any = false;
    for (std::size_t k = 0; k < count_; ++k) {
      if (triangles[k] == kNothing || ended_[k]) {
        ended_[k] = true;
        continue;
      }
      any = true;
      const std::uint16_t instance = scene_.instance(triangles[k]);
      if (std::ranges::find(met_[k], instance) == met_[k].end()) met_[k].push_back(instance);
      // Distances count from the camera, whatever the ray has passed.
      const double distance = passed_[k] + scene_.sample_surface(rays_[k], triangles[k]).distance;
      const double next = std::max(distance, passed_[k]) * (1 + kBehind);
      rays_[k].origin += (next - passed_[k]) * rays_[k].direction;
      passed_[k] = next;
    }
    return any;
  }

  const Scene& scene_;
  std::size_t count_;
  std::array<Ray, kTilePixels> rays_;
  std::array<Met, kTilePixels> met_;
  std::array<double, kTilePixels> passed_{};
  std::array<bool, kTilePixels> ended_{};
};

void extend(InstanceBox& box, int x, int y) {
  box.x0 = std::min(box.x0, x);
  box.x1 = std::max(box.x1, x);
  box.y0 = std::min(box.y0, y);
  box.y1 = std::max(box.y1, y);
}

}  // namespace

InstanceMask LabelRenderer::mask(const StampedPose& pose) const {
  const PinholeCamera& camera = rays_.camera();
  InstanceMask mask{ImageU16(camera.width, camera.height), ImageU8(camera.width, camera.height)};
  const auto render = [&](std::size_t index) {
    const Tile tile = rays_.tile(index);
    trace_tile(scene_, rays_.rays(index), pose,
               [&](std::size_t i, const Ray& /*ray*/, TriangleId triangle) {
                 const std::uint16_t instance = scene_.instance(triangle);
                 mask.instances(tile.x(i), tile.y(i)) = instance;
                 mask.classes(tile.x(i), tile.y(i)) = scene_.class_of(instance);
               });
  };
  parallel_for(rays_.tile_count(), render, kTilesPerTask);
  return mask;
}

NormalMap LabelRenderer::normals(const StampedPose& pose) const {
  const PinholeCamera& camera = rays_.camera();
  const ImageF none(camera.width, camera.height);
  NormalMap map{none, none, none};
  const Eigen::Matrix3d camera_from_world = pose.world_from_camera.rotation_matrix().transpose();
  const auto render = [&](std::size_t index) {
    const Tile tile = rays_.tile(index);
    trace_tile(scene_, rays_.rays(index), pose,
               [&](std::size_t i, const Ray& ray, TriangleId triangle) {
                 if (triangle == kNothing) return;
                 const Eigen::Vector3f normal =
                     (camera_from_world * scene_.normal(ray, triangle)).cast<float>();
                 map.x(tile.x(i), tile.y(i)) = normal.x();
                 map.y(tile.x(i), tile.y(i)) = normal.y();
                 map.z(tile.x(i), tile.y(i)) = normal.z();
               });
  };
  parallel_for(rays_.tile_count(), render, kTilesPerTask);
  return map;
}

std::vector<std::size_t> LabelRenderer::pixels_alone(const StampedPose& pose) const {
  std::vector<std::size_t> pixels(scene_.instances().size() + 1);
  std::mutex mutex;
  const auto count = [&](std::size_t index) {
    TilePeeler peeler(scene_, rays_.rays(index), pose);
    const std::span<const Met> met = peeler.peel();
    const std::scoped_lock lock(mutex);
    for (const Met& instances : met)
      for (const std::uint16_t instance : instances) ++pixels[instance];
  };
  parallel_for(rays_.tile_count(), count, kTilesPerTask);
  return pixels;
}

std::vector<InstanceBox> LabelRenderer::boxes(const StampedPose& pose,
                                              const InstanceMask& mask) const {
  std::vector<InstanceBox> all(scene_.instances().size() + 1);
  std::vector<std::size_t> visible(all.size());
  for (int y = 0; y < mask.instances.height(); ++y)
    for (int x = 0; x < mask.instances.width(); ++x) {
      const std::uint16_t instance = mask.instances(x, y);
      if (visible[instance]++ == 0)
        all[instance] = {pose.t_s, instance, scene_.class_of(instance), x, y, x, y, 1};
      extend(all[instance], x, y);
    }
  const std::vector<std::size_t> alone = pixels_alone(pose);
  std::vector<InstanceBox> boxes;
  for (std::size_t k = 1; k < all.size(); ++k) {
    if (visible[k] == 0) continue;
    const std::size_t whole = std::max(alone[k], visible[k]);
    all[k].visible_fraction = static_cast<double>(visible[k]) / static_cast<double>(whole);
    boxes.push_back(all[k]);
  }
  return boxes;
}

}  // namespace saccade
