#include "simulator/sensor/event_tile.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/check.h"

namespace saccade {
namespace {

/// What a pixel sees at one instant through its kRays rays.
template <std::size_t kRays>
struct PixelSample {
  double t_s = 0;
  double log_intensity = 0;
  std::array<TriangleId, kRays> triangles{};
};

/// What all pixels of a tile see at one instant.
template <std::size_t kRays>
struct TileSample {
  double t_s = 0;
  std::array<double, kTilePixels> log_intensity{};
  std::array<std::array<TriangleId, kRays>, kTilePixels> triangles{};

  [[nodiscard]] PixelSample<kRays> pixel(std::size_t i) const {
    return {t_s, log_intensity[i], triangles[i]};
  }
};

using TileSlopes = std::array<double, kTilePixels>;

/// |dL/dt| of every pixel between two instants; 0 when they are one.
template <std::size_t kRays>
TileSlopes slopes_between(const TileSample<kRays>& a, const TileSample<kRays>& b) {
  const double per_s = b.t_s > a.t_s ? 1 / (b.t_s - a.t_s) : 0;
  TileSlopes slopes;
  for (std::size_t i = 0; i < kTilePixels; ++i)
    slopes[i] = std::abs(b.log_intensity[i] - a.log_intensity[i]) * per_s;
  return slopes;
}

template <std::size_t kRays>
class LockstepTile final : public EventTile {
 public:
  LockstepTile(const EventWorld& world, std::size_t index)
      : world_(world),
        tile_(world.rays.tile(index)),
        directions_(world.rays.rays(index)),
        tolerance_s_(1e-6 * world.options.time_tolerance_us) {
    search_.shortest_s = tolerance_s_;
  }

  void start(const PoseTable& poses, double t_s) override {
    poses_ = &poses;
    trace(t_s);
    for (std::size_t i = 0; i < tile_.pixels(); ++i)
      pixels_[i] = EventPixel(next_.log_intensity[i], world_.options.contrast);
    from_ = to_ = next_;
  }

  void advance(const PoseTable& poses, double t_s, int steps) override {
    poses_ = &poses;
    const double from_s = to_.t_s;
    for (int k = 1; k < steps; ++k) step(from_s + (t_s - from_s) * k / steps);
    step(t_s);
  }

  void finish(const PoseTable& poses) override {
    poses_ = &poses;
    search_step(slopes_);
  }

  [[nodiscard]] double searched_s() const override { return from_.t_s; }
  [[nodiscard]] InverseDepthRange inverse_depths() const override { return inverse_depths_; }

 private:
  using Sample = PixelSample<kRays>;

  void step(double t_s) {
    trace(t_s);
    const TileSlopes slopes_after = slopes_between(to_, next_);
    search_step(slopes_after);
    slopes_before_ = slopes_;
    slopes_ = slopes_after;
    from_ = to_;
    to_ = next_;
  }

  /// All pixels' crossings between from_ and to_.
  void search_step(const TileSlopes& slopes_after) {
    const double step_s = to_.t_s - from_.t_s;
    for (std::size_t i = 0; i < tile_.pixels(); ++i) {
      const Slopes slopes{slopes_before_[i], slopes_after[i]};
      if (may_exit(pixels_[i].band(), from_.log_intensity[i], to_.log_intensity[i], step_s, slopes,
                   search_))
        walk(i, slopes);
    }
  }

  void walk(std::size_t i, const Slopes& slopes) {
    const auto evaluate = [this, i](double t, const Sample& lo, const Sample& hi) {
      return look(i, t, lo, hi);
    };
    const auto emit = [this, i](double t, int polarity) { record(i, t, polarity); };
    const double width_s = walk_step(pixels_[i], world_.options.contrast, from_.pixel(i),
                                     to_.pixel(i), slopes, tolerance_s_, search_, evaluate, emit);
    statistics_.time_bound_s = std::max(statistics_.time_bound_s, width_s);
  }

  void record(std::size_t i, double t_s, int polarity) {
    const double unit_ns = static_cast<double>(world_.options.timestamp_step_ns());
    const auto units = static_cast<TimeNs>(std::llround(t_s * 1e9 / unit_ns));
    events_.push_back({units * world_.options.timestamp_step_ns(),
                       static_cast<std::uint16_t>(tile_.x(i)),
                       static_cast<std::uint16_t>(tile_.y(i)), static_cast<std::int8_t>(polarity)});
  }

  /// All rays of the tile at time `t_s`, into next_.
  void trace(double t_s) {
    const CameraFrame camera = poses_->at(t_s);
    const std::size_t count = directions_.size();
    std::array<Ray, kTilePixels * kRays> rays;
    std::array<TriangleId, kTilePixels * kRays> triangles;
    for (std::size_t k = 0; k < count; ++k)
      rays[k] = {camera.position, camera.rotation * directions_[k], t_s};
    for (std::size_t k = 0; k < count; k += kTilePixels) {
      const std::size_t n = std::min(kTilePixels, count - k);
      world_.scene.visible({&rays[k], n}, {&triangles[k], n});
    }
    statistics_.rays += count;
    next_.t_s = t_s;
    double nearest = std::numeric_limits<double>::infinity();
    double farthest = 0;
    for (std::size_t i = 0; i < tile_.pixels(); ++i) {
      double sum = 0;
      for (std::size_t s = 0; s < kRays; ++s) {
        const std::size_t k = i * kRays + s;
        next_.triangles[i][s] = triangles[k];
        const Shade shade = world_.scene.shade(rays[k], triangles[k]);
        sum += shade.radiance;
        const double distance =
            shade.distance > 0 ? shade.distance : std::numeric_limits<double>::infinity();
        nearest = std::min(nearest, distance);
        farthest = std::max(farthest, distance);
      }
      next_.log_intensity[i] = log_intensity(sum);
    }
    inverse_depths_ = {1 / farthest, 1 / nearest};
  }

  /// Pixel `i` at a time between two samples.
  Sample look(std::size_t i, double t_s, const Sample& lo, const Sample& hi) {
    const CameraFrame camera = poses_->at(t_s);
    Sample sample{t_s, 0, lo.triangles};
    std::array<Ray, kRays> rays;
    for (std::size_t s = 0; s < kRays; ++s)
      rays[s] = {camera.position, camera.rotation * directions_[i * kRays + s], t_s};
    if (lo.triangles != hi.triangles) {
      world_.scene.visible(rays, sample.triangles);
      statistics_.rays += kRays;
    } else {
      statistics_.surface_looks += kRays;
    }
    double sum = 0;
    for (std::size_t s = 0; s < kRays; ++s)
      sum += world_.scene.shade(rays[s], sample.triangles[s]).radiance;
    sample.log_intensity = log_intensity(sum);
    return sample;
  }

  [[nodiscard]] double log_intensity(double radiance_sum) const {
    return std::log(world_.options.log_eps + radiance_sum / static_cast<double>(kRays));
  }

  const EventWorld& world_;
  Tile tile_;
  std::span<const Eigen::Vector3d> directions_;
  double tolerance_s_;
  ExcursionSearch search_;
  const PoseTable* poses_ = nullptr;  ///< of the call in progress
  InverseDepthRange inverse_depths_;
  std::array<EventPixel, kTilePixels> pixels_;
  /// The last three traced instants; the search is between the first two.
  TileSample<kRays> from_, to_, next_;
  TileSlopes slopes_before_{};  ///< of the step before from_
  TileSlopes slopes_{};         ///< of the step from from_ to to_
};

}  // namespace

void EventStatistics::add(const EventStatistics& other) {
  rays += other.rays;
  surface_looks += other.surface_looks;
  time_bound_s = std::max(time_bound_s, other.time_bound_s);
}

std::unique_ptr<EventTile> make_event_tile(const EventWorld& world, std::size_t index) {
  switch (world.rays.rays_per_pixel()) {
    case 1:
      return std::make_unique<LockstepTile<1>>(world, index);
    case 4:
      return std::make_unique<LockstepTile<4>>(world, index);
    case 16:
      return std::make_unique<LockstepTile<16>>(world, index);
    default:
      SACCADE_CHECK(false);
      return nullptr;
  }
}

}  // namespace saccade
