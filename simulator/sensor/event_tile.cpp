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

/// Around a tile, for what a proof over three instants of a slab leaves out between them [px].
constexpr double kMargin_px = 0.5;
/// Longer steps, in multiples of max_step_px, where visibility is proven and the paths over the
/// texture alone set the pace.
constexpr double kLongSteps = 2;

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
        outline_(world.rays.outline(index, kMargin_px)),
        lanes_(directions_.first(tile_.pixels())),
        tracer_(world.scene, statistics_, footprints(world)) {
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
    t_s_ = t_s;
    remember(views);
  }

  void advance(const Slab& slab, const TileMotion& motion) override {
    tracer_.use(slab.poses);
    const bool is_alone = !motion.has_objects && sees_one_triangle(slab.end_s);
    const double step_px = world_.options.max_step_px * (is_alone ? kLongSteps : 1);
    const double steps = std::ceil((is_alone ? 1 : motion.refinement) * motion.pixels / step_px);
    const StepTimes times{t_s_, slab.end_s, std::max(1, static_cast<int>(steps))};
    if (is_alone && is_plane(triangles_[0]))
      advance_on_plane(times);
    else
      advance_in_scene(times, is_alone);
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

  [[nodiscard]] static const PixelRays* footprints(const EventWorld& world) {
    return world.options.texture_filter == TextureFilter::kMipmap ? &world.rays : nullptr;
  }

  /// The end of step k, 1..count.
  struct StepTimes {
    double from_s, to_s;
    int count;

    [[nodiscard]] double end_s(int k) const {
      return k == count ? to_s : from_s + (to_s - from_s) * k / count;
    }
  };

  void advance_in_scene(const StepTimes& times, bool is_alone) {
    // Seen again, so that a tile that was loaded goes on exactly as the one that was saved.
    Views views;
    see(t_s_, views);
    Views next;
    for (int k = 1; k <= times.count; ++k) {
      const double next_s = times.end_s(k);
      is_alone ? see(next_s, next) : trace(next_s, next);
      for (std::size_t i = 0; i < tile_.pixels(); ++i) {
        ++statistics_.stretches;
        if (is_idle(i, next_s) && is_certified(i, views, next, next_s))
          ++statistics_.certified;
        else
          sense(i, sample(i, t_s_, views), sample(i, next_s, next));
      }
      std::swap(views, next);
      t_s_ = next_s;
    }
    remember(views);
  }

  /// Whether the quick way is open: one ray per pixel on an opaque textured plane.
  [[nodiscard]] bool is_plane(TriangleId triangle) const {
    return kRays == 1 && triangle != kNothing && !world_.noise.filter.on() &&
           world_.options.texture_filter == TextureFilter::kBilinear &&
           world_.scene.look({Eigen::Vector3d::Zero(), Eigen::Vector3d::Ones()}, triangle)
                   .texture != nullptr;
  }

  void advance_on_plane(const StepTimes& times) {
    const TriangleId triangle = triangles_[0];
    const TexelMap map = tracer_.texel_map(triangle, t_s_);
    const auto view = [&](const PlaneLanes& lanes, std::size_t i) {
      return RayView{triangle,
                     {map.texture, lanes.x[i], lanes.y[i], map.factor, 1, lanes.distance[i]},
                     lanes.x_rate[i],
                     lanes.y_rate[i]};
    };
    PlaneLanes lanes, next;
    tracer_.see(lanes_, triangle, t_s_, lanes);
    for (int k = 1; k <= times.count; ++k) {
      const double next_s = times.end_s(k);
      tracer_.see(lanes_, triangle, next_s, next);
      const LaneBoxes boxes(lanes, next, next_s - t_s_);
      for (std::size_t i = 0; i < tile_.pixels(); ++i) {
        ++statistics_.stretches;
        if (is_idle(i, next_s) && is_certified(i, boxes, map, next_s))
          ++statistics_.certified;
        else
          sense(i, sample_of(view(lanes, i), t_s_), sample_of(view(next, i), next_s));
      }
      std::swap(lanes, next);
      t_s_ = next_s;
    }
    Views views;
    for (std::size_t i = 0; i < tile_.pixels(); ++i) views[i] = view(lanes, i);
    remember(views);
  }

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

  [[nodiscard]] Sample sample_of(const RayView& view, double t_s) const {
    Sample sample;
    sample.t_s = t_s;
    sample.rays.fill(view);
    sample.log_intensity = log_intensity(sample.radiance(), world_.options.log_eps);
    return sample;
  }

  void sense(std::size_t i, const Sample& lo, const Sample& hi) {
    TilePixel& pixel = pixels_[i];
    const Signal pixel_signal = signal(i);
    const auto emit = [&](double t_s, int polarity, EventOrigin origin, double log_intensity) {
      record(pixel.traits, t_s, polarity, origin, log_intensity);
    };
    PixelSensor sensor(pixel_signal, pixel.traits, world_.options.log_eps, pixel.state,
                       pixel.thresholds, emit);
    const double width_s = noisy_.empty() ? sensor.sense(lo, hi)
                           : world_.noise.filter.on()
                               ? sensor.sense_filtered(lo, hi, world_.noise, noisy_[i])
                               : sensor.sense(lo, hi, world_.noise, noisy_[i]);
    statistics_.time_bound_s = std::max(statistics_.time_bound_s, width_s);
  }

  /// Whether only a crossing could make the pixel fire before `next_s`.
  [[nodiscard]] bool is_idle(std::size_t i, double next_s) const {
    return noisy_.empty() || (!world_.noise.filter.on() && noisy_[i].blind_until_s < t_s_ &&
                              noisy_[i].spontaneous.next_s() >= next_s);
  }

  /// Whether the bounds of the radiance up to `next_s` prove that nothing crosses.
  [[nodiscard]] bool is_certified(std::size_t i, const Views& views, const Views& next,
                                  double next_s) const {
    RadianceRange sum{0, 0, 0, 0};
    for (std::size_t k = i * kRays; k < (i + 1) * kRays; ++k) {
      if (views[k].triangle != next[k].triangle) return false;
      sum.add(radiance_range(views[k], next[k], next_s - t_s_));
    }
    sum.scale(1.0 / kRays);
    return pixels_[i].thresholds.certify(sum, next_s);
  }

  [[nodiscard]] bool is_certified(std::size_t i, const LaneBoxes& boxes, const TexelMap& map,
                                  double next_s) const {
    const TexelRange range =
        map.texture->range({boxes.x0[i], boxes.x1[i], boxes.y0[i], boxes.y1[i]});
    return pixels_[i].thresholds.certify({map.factor * range.low, map.factor * range.high, 0, 0},
                                         next_s);
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

  /// All rays of the tile on the triangles that they saw last.
  void see(double t_s, Views& views) {
    const std::size_t n = directions_.size();
    tracer_.see(directions_, {triangles_.data(), n}, t_s, {views.data(), n});
  }

  /// Whether one triangle is all that can be seen in and around the tile up to `t_s`.
  [[nodiscard]] bool sees_one_triangle(double t_s) const {
    const auto end = triangles_.begin() + static_cast<std::ptrdiff_t>(directions_.size());
    return !tracer_.is_lit() &&
           std::all_of(triangles_.begin(), end, [&](TriangleId t) { return t == triangles_[0]; }) &&
           tracer_.is_alone(triangles_[0], outline_, t_s_, t_s);
  }

  void remember(const Views& views) {
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
  std::array<Eigen::Vector3d, 4> outline_;
  DirectionLanes lanes_;  ///< for one ray per pixel
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
