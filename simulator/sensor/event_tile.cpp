#include "simulator/sensor/event_tile.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "core/check.h"
#include "simulator/sensor/noise/leak.h"
#include "simulator/sensor/noise/mismatch.h"
#include "simulator/sensor/pixel_sensor.h"
#include "simulator/sensor/pixel_signal.h"

namespace saccade {
namespace {

/// A pixel and what it fires at.
struct TilePixel {
  PixelTraits traits;
  PixelState state;
  Thresholds thresholds;
};

template <std::size_t kRays>
class LockstepTile final : public EventTile {
 public:
  LockstepTile(const EventWorld& world, std::size_t index)
      : world_(world),
        tile_(world.rays.tile(index)),
        directions_(world.rays.rays(index)),
        tracer_(world.scene, statistics_) {
    for (std::size_t i = 0; i < tile_.pixels(); ++i) pixels_[i].traits = traits(i);
    if (world.noise.on()) noisy_.resize(tile_.pixels());
  }

  void start(const PoseTable& poses, double t_s) override {
    tracer_.use(poses);
    Views views;
    trace(t_s, views);
    for (std::size_t i = 0; i < tile_.pixels(); ++i) {
      const double level = sample(i, t_s, views).log_intensity;
      TilePixel& pixel = pixels_[i];
      const double drifted = pixel.traits.drift_per_s * t_s;
      pixel.state = {EventPixel(level + drifted, pixel.traits.contrast), t_s};
      update_thresholds(pixel);
      if (!noisy_.empty())
        noisy_[i] = {NoisyState::kNotBlind,
                     world_.noise.spontaneous.start(pixel.traits.x, pixel.traits.y, t_s),
                     PhotoreceptorFilter::settled(level)};
    }
    remember(t_s, views);
  }

  void advance(const PoseTable& poses, double t_s, int steps) override {
    tracer_.use(poses);
    const double from_s = t_s_;
    Views views = views_at_start();
    Views next;
    for (int k = 1; k <= steps; ++k) {
      const double next_s = k == steps ? t_s : from_s + (t_s - from_s) * k / steps;
      trace(next_s, next);
      for (std::size_t i = 0; i < tile_.pixels(); ++i) sense(i, views, next, next_s);
      std::swap(views, next);
      t_s_ = next_s;
    }
    remember(t_s, views);
  }

  [[nodiscard]] InverseDepthRange inverse_depths() const override { return inverse_depths_; }

  void save(StateWriter& state) const override {
    state.value(t_s_);
    state.value(inverse_depths_.low);
    state.value(inverse_depths_.high);
    state.value(triangles_);
    for (const TilePixel& pixel : pixels_) state.value(pixel.state);
    state.values(noisy_);
    state.value(statistics_);
  }

  void load(StateReader& state) override {
    state.value(t_s_);
    state.value(inverse_depths_.low);
    state.value(inverse_depths_.high);
    state.value(triangles_);
    for (TilePixel& pixel : pixels_) {
      state.value(pixel.state);
      update_thresholds(pixel);
    }
    state.values(noisy_);
    state.value(statistics_);
  }

 private:
  using Signal = PixelSignal<kRays>;
  using Sample = PixelSample<kRays>;
  /// What the rays of the tile see, pixel by pixel.
  using Views = std::array<RayView, kTilePixels * kRays>;

  [[nodiscard]] PixelTraits traits(std::size_t i) const {
    const auto x = static_cast<std::uint16_t>(tile_.x(i));
    const auto y = static_cast<std::uint16_t>(tile_.y(i));
    const Contrast contrast = pixel_contrast(world_.options, world_.seed, x, y);
    return {x, y, contrast, leak_slope(world_.options.noise.leak, contrast.on, world_.seed, x, y)};
  }

  void update_thresholds(TilePixel& pixel) const {
    pixel.thresholds =
        Thresholds(pixel.state.level.band(), pixel.traits.drift_per_s, world_.options.log_eps);
  }

  [[nodiscard]] Signal signal(std::size_t i) {
    return Signal(tracer_, directions_.subspan(i * kRays).template first<kRays>(),
                  world_.options.log_eps, 1e-6 * world_.options.time_tolerance_us);
  }

  [[nodiscard]] Sample sample(std::size_t i, double t_s, const Views& views) {
    Sample sample;
    sample.t_s = t_s;
    std::copy_n(&views[i * kRays], kRays, sample.rays.begin());
    signal(i).set_log_intensity(sample);
    return sample;
  }

  void sense(std::size_t i, const Views& views, const Views& next, double next_s) {
    ++statistics_.stretches;
    if (is_certified(i, views, next, next_s)) {
      ++statistics_.certified;
      return;
    }
    TilePixel& pixel = pixels_[i];
    const Signal pixel_signal = signal(i);
    const auto emit = [&](double t_s, int polarity, EventOrigin origin, double log_intensity) {
      record(pixel.traits, t_s, polarity, origin, log_intensity);
    };
    PixelSensor sensor(pixel_signal, pixel.traits, world_.options.log_eps, pixel.state,
                       pixel.thresholds, emit);
    const Sample lo = sample(i, t_s_, views);
    const Sample hi = sample(i, next_s, next);
    const double width_s = noisy_.empty() ? sensor.sense(lo, hi)
                           : world_.noise.filter.on()
                               ? sensor.sense_filtered(lo, hi, world_.noise, noisy_[i])
                               : sensor.sense(lo, hi, world_.noise, noisy_[i]);
    statistics_.time_bound_s = std::max(statistics_.time_bound_s, width_s);
  }

  /// Whether the step can be passed over: nothing can have fired.
  [[nodiscard]] bool is_certified(std::size_t i, const Views& views, const Views& next,
                                  double next_s) const {
    if (!noisy_.empty() && (world_.noise.filter.on() || noisy_[i].blind_until_s >= t_s_ ||
                            noisy_[i].spontaneous.next_s() < next_s))
      return false;
    RadianceRange sum{0, 0, 0, 0};
    for (std::size_t k = i * kRays; k < (i + 1) * kRays; ++k) {
      if (views[k].triangle != next[k].triangle) return false;
      sum.add(radiance_range(views[k], next[k], next_s - t_s_));
    }
    sum.scale(1.0 / kRays);
    return pixels_[i].thresholds.certify(sum, next_s);
  }

  void record(const PixelTraits& pixel, double t_s, int polarity, EventOrigin origin,
              double log_intensity) {
    const double unit_ns = static_cast<double>(world_.options.timestamp_step_ns());
    const auto units = static_cast<TimeNs>(std::llround(t_s * 1e9 / unit_ns));
    events_.push_back({units * world_.options.timestamp_step_ns(), pixel.x, pixel.y,
                       static_cast<std::int8_t>(polarity), origin,
                       static_cast<float>(log_intensity)});
  }

  /// All rays of the tile.
  void trace(double t_s, Views& views) {
    for (std::size_t k = 0; k < directions_.size(); k += RayTracer::kPacket) {
      const std::size_t n = std::min(RayTracer::kPacket, directions_.size() - k);
      tracer_.trace(directions_.subspan(k, n), t_s, {&views[k], n});
    }
  }

  /// The views that the last advance() ended with. Seen again, so that a tile that was loaded goes
  /// on exactly as the one that was saved.
  [[nodiscard]] Views views_at_start() {
    Views views;
    for (std::size_t k = 0; k < directions_.size(); ++k)
      views[k] = tracer_.view(directions_[k], triangles_[k], t_s_);
    return views;
  }

  void remember(double t_s, const Views& views) {
    t_s_ = t_s;
    double nearest = std::numeric_limits<double>::infinity();
    double farthest = 0;
    for (std::size_t k = 0; k < directions_.size(); ++k) {
      triangles_[k] = views[k].triangle;
      const double distance = views[k].look.distance > 0 ? views[k].look.distance
                                                         : std::numeric_limits<double>::infinity();
      nearest = std::min(nearest, distance);
      farthest = std::max(farthest, distance);
    }
    inverse_depths_ = {1 / farthest, 1 / nearest};
  }

  const EventWorld& world_;
  Tile tile_;
  std::span<const Eigen::Vector3d> directions_;
  RayTracer tracer_;
  double t_s_ = 0;  ///< up to which the tile has sensed
  InverseDepthRange inverse_depths_;
  std::array<TriangleId, kTilePixels * kRays> triangles_{};  ///< seen at t_s_
  std::array<TilePixel, kTilePixels> pixels_;
  std::vector<NoisyState> noisy_;  ///< one per pixel, or none
};

}  // namespace

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
