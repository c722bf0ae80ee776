#include "simulator/sensor/event_tile.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include "core/check.h"
#include "simulator/sensor/noise/leak.h"
#include "simulator/sensor/noise/mismatch.h"
#include "simulator/sensor/passing.h"
#include "simulator/sensor/pixel_sensor.h"
#include "simulator/sensor/pixel_signal.h"
#include "simulator/sensor/plane_signal.h"

namespace saccade {
namespace {

/// Around a tile, for what a proof over three instants of a slab leaves out between them [px].
constexpr double kMargin_px = 0.5;
/// Longer steps, in multiples of max_step_px, where visibility is proven and the paths over the
/// texture alone set the pace.
constexpr double kLongSteps = 2;

/// Where no more triangles than this are in reach of a tile, each of its pixels looks when one of
/// them passes between two steps.
constexpr std::size_t kMostCandidates = 64;

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
        tolerance_s_(1e-6 * world.options.time_tolerance_us),
        lanes_(directions_.first(tile_.pixels())),
        is_bilinear_(world.options.texture_filter == TextureFilter::kBilinear),
        tracer_(world.scene, statistics_, footprints(world)) {
    for (std::size_t i = 0; i < tile_.pixels(); ++i) pixels_[i].traits = traits(i);
    if (world.noise.on()) noisy_.resize(tile_.pixels());
  }

  void start(const PoseTable& poses, double t_s) override {
    tracer_.use(poses);
    TileLook look;
    trace(t_s, look);
    for (std::size_t i = 0; i < tile_.pixels(); ++i) {
      const double level = sample(look, i).log_intensity;
      TilePixel& pixel = pixels_[i];
      const double drifted = pixel.traits.drift_per_s * t_s;
      pixel.state = {EventPixel(level + drifted, pixel.traits.contrast), t_s};
      update_thresholds(pixel);
      if (!noisy_.empty())
        noisy_[i] = {NoisyState::kNotBlind,
                     world_.noise.spontaneous.start(pixel.traits.x, pixel.traits.y, t_s),
                     PhotoreceptorFilter::settled(level)};
    }
    remember(look);
  }

  void advance(const Slab& slab, const TileMotion& motion) override {
    tracer_.use(slab.poses);
    const bool is_alone = !motion.has_objects && sees_one_triangle(slab.end_s);
    const bool foresees = !is_alone && !motion.has_objects &&
                          tracer_.collect(outline_, 1 / inverse_depths_.low, t_s_, slab.end_s,
                                          kMostCandidates, candidates_);
    if (!foresees) candidates_.clear();
    const double step_px = world_.options.max_step_px * (is_alone ? kLongSteps : 1);
    const double refinement = is_alone || foresees ? 1 : motion.refinement;
    const double steps = std::ceil(refinement * motion.pixels / step_px);
    const int count = std::max(1, static_cast<int>(steps));
    const double from_s = t_s_;
    TileLook look, next;
    // Seen again, so that a tile that was loaded goes on exactly as the one that was saved.
    see(triangles_, t_s_, look);
    for (int k = 1; k <= count; ++k) {
      const double t_s = k == count ? slab.end_s : from_s + (slab.end_s - from_s) * k / count;
      is_alone ? see(triangles_, t_s, next) : trace(t_s, next);
      sense_step(look, next);
      std::swap(look, next);
      t_s_ = t_s;
    }
    remember(look);
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
  using Triangles = std::array<TriangleId, kTilePixels * kRays>;

  [[nodiscard]] static const PixelRays* footprints(const EventWorld& world) {
    return world.options.texture_filter == TextureFilter::kMipmap ? &world.rays : nullptr;
  }

  /// What the rays of the tile see at an instant: all of them one texture, or each for itself.
  struct TileLook {
    double t_s;
    bool on_plane;
    TriangleId triangle;  ///< on the plane
    TexelMap map;
    PlaneLanes lanes;
    std::array<RayView, kTilePixels * kRays> views;  ///< else; pixel by pixel

    [[nodiscard]] RayView view(std::size_t k) const {
      if (!on_plane) return views[k];
      return {triangle,
              {map.texture, lanes.x[k], lanes.y[k], map.factor, 1, lanes.distance[k]},
              lanes.x_rate[k],
              lanes.y_rate[k]};
    }
  };

  void sense_step(const TileLook& look, const TileLook& next) {
    const double length_s = next.t_s - look.t_s;
    const bool on_plane = look.on_plane && next.on_plane && look.triangle == next.triangle;
    find_passing(look.t_s, next.t_s);
    std::optional<LaneBoxes> boxes;
    if (on_plane) boxes.emplace(look.lanes, next.lanes, length_s);
    for (std::size_t i = 0; i < tile_.pixels(); ++i) {
      ++statistics_.stretches;
      if (any_passes(i, look, next))
        sense_passing(i, sample(look, i), sample(next, i));
      else if (is_idle(i, look.t_s, next.t_s) &&
               (on_plane ? is_certified(i, *boxes, next.map, next.t_s)
                         : is_certified(i, look, next)))
        ++statistics_.certified;
      else if (on_plane)
        sense_on_plane(i, look, next);
      else
        sense(i, signal(i), sample(look, i), sample(next, i));
    }
  }

  void sense_on_plane(std::size_t i, const TileLook& look, const TileLook& next) {
    const PlaneSignal plane(tracer_, directions_[i], next.triangle, next.map,
                            world_.options.log_eps, tolerance_s_);
    const auto sample = [&](const TileLook& at) {
      const PlaneLanes& lanes = at.lanes;
      return plane.sample(at.t_s, lanes.x[i], lanes.y[i], lanes.x_rate[i], lanes.y_rate[i]);
    };
    sense(i, plane, sample(look), sample(next));
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
                  world_.options.log_eps, tolerance_s_);
  }

  [[nodiscard]] Sample sample(const TileLook& look, std::size_t i) const {
    Sample sample;
    sample.t_s = look.t_s;
    for (std::size_t k = 0; k < kRays; ++k) sample.rays[k] = look.view(i * kRays + k);
    sample.log_intensity = log_intensity(sample.radiance(), world_.options.log_eps);
    return sample;
  }

  template <class AnySignal, class AnySample>
  void sense(std::size_t i, const AnySignal& pixel_signal, const AnySample& lo,
             const AnySample& hi) {
    TilePixel& pixel = pixels_[i];
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

  /// The candidates that may pass through some ray of the tile between two looks.
  void find_passing(double from_s, double to_s) {
    passing_.clear();
    if (candidates_.empty()) return;
    const std::array<CameraFrame, 3> cameras{tracer_.camera_at(from_s),
                                             tracer_.camera_at(0.5 * (from_s + to_s)),
                                             tracer_.camera_at(to_s)};
    for (const TriangleId candidate : candidates_) {
      PassingTriangle passing{candidate, {}};
      for (std::size_t m = 0; m < cameras.size(); ++m)
        passing.at[m] =
            world_.scene.triangle_pass(candidate, cameras[m].position, cameras[m].rotation);
      if (!passing.misses(outline_)) passing_.push_back(passing);
    }
  }

  /// Collects the times, in order, at which triangles pass through a ray of a pixel between two
  /// looks that both see others, or leave it between two that see them; whether there are any.
  [[nodiscard]] bool any_passes(std::size_t i, const TileLook& look, const TileLook& next) {
    passing_s_.clear();
    if (passing_.empty()) return false;
    for (std::size_t k = i * kRays; k < (i + 1) * kRays; ++k) {
      const RayView lo = look.view(k);
      const RayView hi = next.view(k);
      const bool is_open = lo.look.distance == 0 || hi.look.distance == 0;
      const double hidden_beyond = is_open ? std::numeric_limits<double>::infinity()
                                           : std::max(lo.look.distance, hi.look.distance);
      for (const PassingTriangle& passing : passing_) {
        if (passing.triangle == lo.triangle || passing.triangle == hi.triangle) {
          if (lo.triangle == hi.triangle && passing.leaves(directions_[k]))
            passing_s_.push_back(0.5 * (look.t_s + next.t_s));
          continue;
        }
        for (std::size_t half = 0; half < 2; ++half) {
          const double fraction = passing.passing_fraction(directions_[k], hidden_beyond, half);
          if (fraction > 0 && fraction < 1)
            passing_s_.push_back(look.t_s + fraction * (next.t_s - look.t_s));
        }
      }
    }
    std::sort(passing_s_.begin(), passing_s_.end());
    return !passing_s_.empty();
  }

  /// sense() with looks at passing_s_.
  void sense_passing(std::size_t i, Sample lo, const Sample& hi) {
    const Signal pixel_signal = signal(i);
    for (const double t_s : passing_s_) {
      if (t_s - lo.t_s < tolerance_s_ || hi.t_s - t_s < tolerance_s_) continue;
      const Sample middle = pixel_signal.look(t_s);
      sense(i, pixel_signal, lo, middle);
      lo = middle;
    }
    sense(i, pixel_signal, lo, hi);
  }

  /// Whether only a crossing could make the pixel fire between two times.
  [[nodiscard]] bool is_idle(std::size_t i, double from_s, double next_s) const {
    return noisy_.empty() || (!world_.noise.filter.on() && noisy_[i].blind_until_s < from_s &&
                              noisy_[i].spontaneous.next_s() >= next_s);
  }

  /// Whether the bounds of the radiance prove that nothing crosses.
  [[nodiscard]] bool is_certified(std::size_t i, const TileLook& look, const TileLook& next) const {
    RadianceRange sum{0, 0, 0, 0};
    for (std::size_t k = i * kRays; k < (i + 1) * kRays; ++k) {
      const RayView from = look.view(k);
      const RayView to = next.view(k);
      if (from.triangle != to.triangle) return false;
      sum.add(radiance_range(from, to, next.t_s - look.t_s));
    }
    sum.scale(1.0 / kRays);
    return pixels_[i].thresholds.certify(sum, next.t_s);
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

  void trace(double t_s, TileLook& look) {
    Triangles triangles;
    const std::size_t n = directions_.size();
    for (std::size_t k = 0; k < n; k += RayTracer::kPacket) {
      const std::size_t some = std::min(RayTracer::kPacket, n - k);
      tracer_.find_triangles(directions_.subspan(k, some), t_s, {&triangles[k], some});
    }
    see(triangles, t_s, look);
  }

  /// The visible triangles are known.
  void see(const Triangles& triangles, double t_s, TileLook& look) {
    look.t_s = t_s;
    look.on_plane = false;
    if (kRays == 1 && is_bilinear_ && are_equal(triangles) && tracer_.is_plane(triangles[0])) {
      look.triangle = triangles[0];
      look.map = tracer_.see(lanes_, look.triangle, t_s, look.lanes);
      look.on_plane = look.map.texture != nullptr;
    }
    const std::size_t n = directions_.size();
    if (!look.on_plane)
      tracer_.see(directions_, {triangles.data(), n}, t_s, {look.views.data(), n});
  }

  [[nodiscard]] bool are_equal(const Triangles& triangles) const {
    const auto end = triangles.begin() + static_cast<std::ptrdiff_t>(directions_.size());
    return std::all_of(triangles.begin(), end, [&](TriangleId t) { return t == triangles[0]; });
  }

  /// Whether one triangle is all that can be seen in and around the tile up to `t_s`.
  [[nodiscard]] bool sees_one_triangle(double t_s) const {
    return !tracer_.is_lit() && are_equal(triangles_) &&
           tracer_.is_alone(triangles_[0], outline_, t_s_, t_s);
  }

  void remember(const TileLook& look) {
    t_s_ = look.t_s;
    double nearest = std::numeric_limits<double>::infinity();
    double farthest = 0;
    for (std::size_t k = 0; k < directions_.size(); ++k) {
      const RayView view = look.view(k);
      triangles_[k] = view.triangle;
      const double distance =
          view.look.distance > 0 ? view.look.distance : std::numeric_limits<double>::infinity();
      nearest = std::min(nearest, distance);
      farthest = std::max(farthest, distance);
    }
    inverse_depths_ = {1 / farthest, 1 / nearest};
  }

  const EventWorld& world_;
  Tile tile_;
  std::span<const Eigen::Vector3d> directions_;
  std::array<Eigen::Vector3d, 4> outline_;
  double tolerance_s_;
  DirectionLanes lanes_;  ///< for one ray per pixel
  bool is_bilinear_;
  RayTracer tracer_;
  double t_s_ = 0;  ///< up to which the tile has sensed
  InverseDepthRange inverse_depths_;
  Triangles triangles_{};  ///< seen at t_s_
  std::array<TilePixel, kTilePixels> pixels_;
  std::vector<TriangleId> candidates_;    ///< that may come into view within the slab
  std::vector<PassingTriangle> passing_;  ///< of them, within the step
  std::vector<double> passing_s_;         ///< of the pixel that is at work
  std::vector<NoisyState> noisy_;         ///< one per pixel, or none
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
