#include <algorithm>
#include <array>

#include "simulator/sensor/event_tile.h"

namespace saccade {
namespace {

/// The rays of a tile, seen at the end of each slice alone.
class DepthTile final : public EventTile {
 public:
  DepthTile(const TileContext& context, std::size_t index)
      : EventTile(
            PixelBank(context.options, context.noise, context.seed, context.rays.tile(index))),
        directions_(context.rays.rays(index)),
        per_pixel_(context.rays.rays_per_pixel()),
        tracer_(context.scene, statistics_) {}

  void start(const SplineTable& poses, double t_s) override {
    tracer_.set_poses(poses);
    trace(t_s);
  }

  void advance(const TimeSlice& slice, const TileMotion& /*motion*/) override {
    tracer_.set_poses(slice.poses);
    trace(slice.end_s);
  }

  [[nodiscard]] InverseDepthRange inverse_depths() const override { return inverse_depths_; }

  void save(StateWriter& state) const override {
    state.value(inverse_depths_.low);
    state.value(inverse_depths_.high);
    state.value(statistics_);
  }

  void load(StateReader& state) override {
    state.value(inverse_depths_.low);
    state.value(inverse_depths_.high);
    state.value(statistics_);
  }

 private:
  /// One ray of each pixel: what lies between two of them is seen by neither camera.
  void trace(double t_s) {
    std::array<Eigen::Vector3d, kMaxTilePixels> rays;
    std::array<TriangleId, kMaxTilePixels> triangles;
    const std::size_t n = directions_.size() / per_pixel_;
    for (std::size_t i = 0; i < n; ++i) rays[i] = directions_[i * per_pixel_];
    for (std::size_t first = 0; first < n; first += kRayPacket) {
      const std::size_t count = std::min(kRayPacket, n - first);
      tracer_.find_triangles({&rays[first], count}, t_s, {&triangles[first], count});
    }
    inverse_depths_ = tracer_.inverse_depths({rays.data(), n}, {triangles.data(), n}, t_s);
  }

  std::span<const Eigen::Vector3d> directions_;
  std::size_t per_pixel_;
  RayTracer tracer_;
  InverseDepthRange inverse_depths_;
};

}  // namespace

std::unique_ptr<EventTile> make_depth_tile(const TileContext& context, std::size_t index) {
  return std::make_unique<DepthTile>(context, index);
}

}  // namespace saccade
