#include "simulator/sensor/event_tile.h"

#include <algorithm>
#include <array>
#include <bitset>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include "core/check.h"
#include "simulator/sensor/foresight.h"
#include "simulator/sensor/pixel_sensor.h"
#include "simulator/sensor/pixel_signal.h"
#include "simulator/sensor/plane_signal.h"

namespace saccade {
namespace {

/// Around a tile, for what a proof over some instants of a slab leaves out between them [px].
constexpr double kMargin_px = 0.5;
/// Longer steps, in multiples of max_step_px, where visibility is proven and the paths over the
/// texture alone set the pace.
constexpr double kLongSteps = 2;

/// Nearer than this to an edge a pixel's view may change [px].
constexpr double kEdge_px = 0.05;

/// So far from the change of what a pixel sees it is looked at on both sides [tolerances].
constexpr double kAroundChange = 0.45;

/// The paths of a tile's pixels over a triangle.
struct TriangleCourse {
  TriangleId triangle;
  SurfaceLook surface;
  PlanePaths paths;
};

/// Those over the triangles that a tile has looked at last, for a stretch of time.
class TilePaths {
 public:
  TilePaths(double from, double to) : from_s(from), to_s(to) {}

  [[nodiscard]] const TriangleCourse* find(TriangleId triangle) const {
    for (std::size_t k = 0; k < std::min(count_, courses_.size()); ++k)
      if (courses_[k].triangle == triangle) return &courses_[k];
    return nullptr;
  }
  /// In place of the oldest. Leaves those added in the last call as they are.
  TriangleCourse& add(TriangleId triangle) {
    TriangleCourse& course = courses_[count_++ % courses_.size()];
    course.triangle = triangle;
    return course;
  }

  const double from_s, to_s;

 private:
  std::array<TriangleCourse, 4> courses_;
  std::size_t count_ = 0;
};

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
        tracer_(world.scene, statistics_, footprints(world)),
        foresight_(world.scene, tracer_, outline_, kEdge_px / world.rays.camera().fx,
                   tolerance_s_) {
    for (std::size_t i = 0; i < tile_.pixels(); ++i) pixels_[i].traits = traits(i);
    if (world.noise.on()) noisy_.resize(tile_.pixels());
  }

  void start(const PoseTable& poses, double t_s) override {
    tracer_.use(poses);
    TileLook look;
    trace(t_s, look);
    add_views(look);
    for (std::size_t i = 0; i < tile_.pixels(); ++i) {
      const double level = sample(look, i).log_intensity;
      TilePixel& pixel = pixels_[i];
      pixel.state = start_pixel(pixel.traits, level, t_s);
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
    if (look_ahead(slab.end_s, motion)) {
      advance_to(slab.end_s, motion);
      return;
    }
    // Fewer triangles come within reach in half the time.
    const double middle_s = 0.5 * (t_s_ + slab.end_s);
    TileMotion half = motion;
    half.pixels *= 0.5;
    for (const double end_s : {middle_s, slab.end_s}) {
      look_ahead(end_s, half);
      advance_to(end_s, half);
    }
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
  using PixelSet = std::bitset<kTilePixels>;

  /// Equal steps through a slab.
  struct Steps {
    double from_s, to_s;
    int count;

    [[nodiscard]] double operator()(int k) const {
      return k == count ? to_s : from_s + (to_s - from_s) * k / count;
    }
  };
  struct StepRange {
    int from, to;
    std::size_t depth;  ///< halvings that led to it
  };

  [[nodiscard]] static const PixelRays* footprints(const EventWorld& world) {
    return world.options.texture_filter == TextureFilter::kMipmap ? &world.rays : nullptr;
  }

  /// Finds out what can come into view up to `end_s`: whether that is known.
  bool look_ahead(double end_s, const TileMotion& motion) {
    tracer_.use(outline_, t_s_, end_s);
    is_alone_ = !motion.has_objects && sees_one_triangle(end_s);
    if (is_alone_) foresight_.forget();
    foresees_ = !is_alone_ && foresight_.collect(motion.farthest_m, t_s_, end_s);
    return is_alone_ || foresees_;
  }

  void advance_to(double end_s, const TileMotion& motion) {
    const double step_px = world_.options.max_step_px * (is_alone_ ? kLongSteps : 1);
    const double refinement = is_alone_ || foresees_ ? 1 : motion.refinement;
    const int count =
        std::max(1, static_cast<int>(std::ceil(refinement * motion.pixels / step_px)));
    TileLook look, next;
    // Seen again, so that a tile that was loaded goes on exactly as the one that was saved.
    see(triangles_, t_s_, look);
    is_alone_ ? see(triangles_, end_s, next) : trace(end_s, next);
    PixelSet all;
    for (std::size_t i = 0; i < tile_.pixels(); ++i) all.set(i);
    statistics_.stretches += tile_.pixels();
    sense_between({0, count, 0}, {t_s_, end_s, count}, look, next, all);
    remember(next);
  }

  /// What the rays of the tile see at an instant: which triangles, and, where it is asked for, what
  /// of them.
  struct TileLook {
    double t_s;
    Triangles triangles;
    bool has_views;
    std::array<RayView, kTilePixels * kRays> views;  ///< pixel by pixel
  };

  /// Senses `pixels` between two looks: at once where they see one surface all the time, else in
  /// the two halves of the steps.
  void sense_between(const StepRange& range, const Steps& steps, TileLook& look, TileLook& next,
                     PixelSet pixels) {
    foresight_.narrow(look.t_s, next.t_s, range.depth);
    if (kRays == 1 && is_bilinear_ && (is_alone_ || foresight_.has_any()))
      pixels = sense_steady(look, next, pixels);
    if (pixels.none()) return;
    if (range.to - range.from == 1) {
      add_views(look);
      add_views(next);
      return sense_step(look, next, pixels);
    }
    const int middle = (range.from + range.to) / 2;
    TileLook between;
    is_alone_ ? see(triangles_, steps(middle), between) : trace(steps(middle), between, pixels);
    statistics_.stretches += pixels.count();
    sense_between({range.from, middle, range.depth + 1}, steps, look, between, pixels);
    sense_between({middle, range.to, range.depth + 1}, steps, between, next, pixels);
  }

  /// Senses those pixels that see one textured plane all the time, or one and then another. Returns
  /// the others.
  PixelSet sense_steady(const TileLook& look, const TileLook& next, PixelSet pixels) {
    TilePaths paths(look.t_s, next.t_s);
    for (std::size_t i = 0; i < tile_.pixels(); ++i) {
      if (!pixels[i]) continue;
      const TriangleId from = look.triangles[i];
      const TriangleId to = next.triangles[i];
      if (!tracer_.is_plane(from) || !tracer_.is_plane(to)) continue;
      if (from == to ? sense_plane(i, from, paths) : sense_change(i, from, to, paths))
        pixels.reset(i);
    }
    return pixels;
  }

  /// Whether a pixel sees just the plane of a triangle; it is sensed then.
  bool sense_plane(std::size_t i, TriangleId triangle, TilePaths& paths) {
    if (!is_alone_ && !foresight_.stays_in_sight(directions_[i], triangle)) return false;
    const TriangleCourse& course = find_course(triangle, paths);
    const PlanePath path = course.paths.path(i);
    if (!is_walkable(course, path)) return false;
    sense_path(i, path, course.surface, paths.from_s, paths.to_s);
    return true;
  }

  /// The same for the planes of two, one after the other: around the change on the pixel's general
  /// signal.
  bool sense_change(std::size_t i, TriangleId from, TriangleId to, TilePaths& paths) {
    if (is_alone_) return false;
    const double change_s =
        foresight_.change_s(directions_[i], {from, paths.from_s}, {to, paths.to_s});
    const double before_s = change_s - kAroundChange * tolerance_s_;
    const double after_s = change_s + kAroundChange * tolerance_s_;
    if (!(before_s > paths.from_s && after_s < paths.to_s)) return false;
    const TriangleCourse& first = find_course(from, paths);
    const PlanePath path = first.paths.path(i);
    if (!is_walkable(first, path)) return false;
    const TriangleCourse& second = find_course(to, paths);
    const PlanePath next_path = second.paths.path(i);
    if (!is_walkable(second, next_path)) return false;
    const Signal pixel_signal = signal(i);
    const Sample before = pixel_signal.look(before_s);
    const Sample after = pixel_signal.look(after_s);
    if (before.rays[0].triangle != from || after.rays[0].triangle != to) return false;
    sense_path(i, path, first.surface, paths.from_s, before_s);
    sense(i, pixel_signal, before, after);
    sense_path(i, next_path, second.surface, after_s, paths.to_s);
    return true;
  }

  [[nodiscard]] bool is_walkable(const TriangleCourse& course, const PlanePath& path) const {
    return course.surface.texture != nullptr && path.is_exact(tolerance_s_);
  }

  void sense_path(std::size_t i, const PlanePath& path, const SurfaceLook& surface, double from_s,
                  double to_s) {
    if (is_idle(i, from_s, to_s) && is_certified(i, path, surface, from_s, to_s)) return;
    const PlaneSignal plane(path, surface, world_.options.log_eps, tolerance_s_);
    const bool is_known = !noisy_.empty();
    sense(i, plane, plane.place(from_s, is_known), plane.place(to_s, is_known));
  }

  /// The paths over a triangle that is seen.
  const TriangleCourse& find_course(TriangleId triangle, TilePaths& paths) const {
    if (const TriangleCourse* known = paths.find(triangle)) return *known;
    TriangleCourse& course = paths.add(triangle);
    const PlaneView from = tracer_.plane_view(triangle, paths.from_s);
    from.at(lanes_, course.paths.from);
    tracer_.plane_view(triangle, 0.5 * (paths.from_s + paths.to_s)).at(lanes_, course.paths.middle);
    tracer_.plane_view(triangle, paths.to_s).at(lanes_, course.paths.to);
    course.paths.from_s = paths.from_s;
    course.paths.length_s = paths.to_s - paths.from_s;
    course.surface = from.surface();
    return course;
  }

  void sense_step(const TileLook& look, const TileLook& next, const PixelSet& pixels) {
    for (std::size_t i = 0; i < tile_.pixels(); ++i) {
      if (!pixels[i]) continue;
      if (any_passes(i, look, next))
        sense_passing(i, sample(look, i), sample(next, i));
      else if (is_idle(i, look.t_s, next.t_s) && is_certified(i, look, next) &&
               !any_shadow_passes(i, sample(look, i), sample(next, i)))
        ++statistics_.certified;
      else
        sense_lit(i, signal(i), sample(look, i), sample(next, i));
    }
  }

  [[nodiscard]] PixelTraits traits(std::size_t i) const {
    const auto x = static_cast<std::uint16_t>(tile_.x(i));
    const auto y = static_cast<std::uint16_t>(tile_.y(i));
    return pixel_traits(world_.options, world_.seed, x, y);
  }

  void update_thresholds(TilePixel& pixel) const {
    pixel.thresholds = Thresholds(pixel.state.level.band(), pixel.traits.drift_per_s,
                                  world_.options.log_eps, pixel.state.reference_s);
  }

  [[nodiscard]] Signal signal(std::size_t i) {
    return Signal(tracer_, directions_.subspan(i * kRays).template first<kRays>(),
                  world_.options.log_eps, tolerance_s_);
  }

  [[nodiscard]] Sample sample(const TileLook& look, std::size_t i) const {
    Sample sample;
    sample.t_s = look.t_s;
    for (std::size_t k = 0; k < kRays; ++k) sample.rays[k] = look.views[i * kRays + k];
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

  /// Collects the times, in order, at which a pixel must look to see what passes between two looks;
  /// whether there are any.
  [[nodiscard]] bool any_passes(std::size_t i, const TileLook& look, const TileLook& next) {
    passing_s_.clear();
    if (!foresight_.has_any()) return false;
    foresight_.turn_to(directions_.subspan(i * kRays, kRays));
    for (std::size_t k = i * kRays; k < (i + 1) * kRays; ++k)
      foresight_.find_passes(directions_[k], {look.t_s, look.views[k]}, {next.t_s, next.views[k]},
                             passing_s_);
    std::sort(passing_s_.begin(), passing_s_.end());
    return !passing_s_.empty();
  }

  /// sense() with looks at passing_s_.
  void sense_passing(std::size_t i, Sample lo, const Sample& hi) {
    const Signal pixel_signal = signal(i);
    for (const double t_s : passing_s_) {
      if (t_s - lo.t_s < tolerance_s_ || hi.t_s - t_s < tolerance_s_) continue;
      const Sample middle = pixel_signal.look(t_s);
      sense_lit(i, pixel_signal, lo, middle);
      lo = middle;
    }
    sense_lit(i, pixel_signal, lo, hi);
  }

  /// sense() with looks around the times at which shadows come or go.
  void sense_lit(std::size_t i, const Signal& pixel_signal, Sample lo, const Sample& hi) {
    if (any_shadow_passes(i, lo, hi)) {
      for (const double t_s : shadow_s_) {
        if (!(t_s > lo.t_s && t_s < hi.t_s)) continue;
        const Sample middle = pixel_signal.look_again(t_s, lo, hi);
        sense(i, pixel_signal, lo, middle);
        lo = middle;
      }
    }
    sense(i, pixel_signal, lo, hi);
  }

  /// The same for shadows.
  [[nodiscard]] bool any_shadow_passes(std::size_t i, const Sample& lo, const Sample& hi) {
    shadow_s_.clear();
    if (!tracer_.is_lit()) return false;
    for (std::size_t k = 0; k < kRays; ++k)
      foresight_.find_shadows(directions_[i * kRays + k], {lo.rays[k].triangle, lo.t_s},
                              {hi.rays[k].triangle, hi.t_s}, shadow_s_);
    std::sort(shadow_s_.begin(), shadow_s_.end());
    return !shadow_s_.empty();
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
      const RayView& from = look.views[k];
      const RayView& to = next.views[k];
      if (from.triangle != to.triangle) return false;
      sum.add(radiance_range(from, to, next.t_s - look.t_s));
    }
    sum.scale(1.0 / kRays);
    return pixels_[i].thresholds.certify(sum, next.t_s);
  }

  /// The same along a part of a path.
  [[nodiscard]] bool is_certified(std::size_t i, const PlanePath& path, const SurfaceLook& surface,
                                  double from_s, double to_s) const {
    const double from = path.fraction(from_s);
    const double to = path.fraction(to_s);
    const Interval x = TrackPart(path.x, from, to).values;
    const Interval y = TrackPart(path.y, from, to).values;
    const TexelRange texels = surface.texture->range({x.low, x.high, y.low, y.high});
    const double low = surface.factor * static_cast<double>(texels.low);
    const double high = surface.factor * static_cast<double>(texels.high);
    const Interval silent = pixels_[i].thresholds.radiances(to_s);
    return low > silent.low && high < silent.high;
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
    PixelSet all;
    trace(t_s, look, all.set());
  }

  /// Of the other pixels nothing is known then.
  void trace(double t_s, TileLook& look, const PixelSet& pixels) {
    Triangles triangles;
    triangles.fill(kNothing);
    std::array<Eigen::Vector3d, RayTracer::kPacket> rays;
    std::array<std::size_t, RayTracer::kPacket> owners;
    std::array<TriangleId, RayTracer::kPacket> seen;
    std::size_t n = 0;
    const auto flush = [&] {
      tracer_.find_triangles({rays.data(), n}, t_s, {seen.data(), n});
      for (std::size_t m = 0; m < n; ++m) triangles[owners[m]] = seen[m];
      n = 0;
    };
    for (std::size_t k = 0; k < directions_.size(); ++k) {
      if (!pixels[k / kRays]) continue;
      rays[n] = directions_[k];
      owners[n++] = k;
      if (n == RayTracer::kPacket) flush();
    }
    if (n > 0) flush();
    see(triangles, t_s, look);
  }

  /// The visible triangles are known.
  void see(const Triangles& triangles, double t_s, TileLook& look) {
    look.t_s = t_s;
    look.triangles = triangles;
    look.has_views = false;
  }

  void add_views(TileLook& look) {
    if (look.has_views) return;
    look.has_views = true;
    const std::size_t n = directions_.size();
    tracer_.see(directions_, {look.triangles.data(), n}, look.t_s, {look.views.data(), n});
  }

  [[nodiscard]] bool are_equal(const Triangles& triangles) const {
    const auto end = triangles.begin() + static_cast<std::ptrdiff_t>(directions_.size());
    return std::all_of(triangles.begin(), end, [&](TriangleId t) { return t == triangles[0]; });
  }

  /// Whether one triangle, in even light, is all that can be seen in and around the tile up to
  /// `t_s`.
  [[nodiscard]] bool sees_one_triangle(double t_s) {
    return are_equal(triangles_) && tracer_.is_alone(triangles_[0], outline_, t_s_, t_s) &&
           is_evenly_lit(triangles_[0]);
  }

  [[nodiscard]] bool is_evenly_lit(TriangleId triangle) {
    if (!tracer_.is_lit() || triangle == kNothing) return true;
    const PatchLight* light = tracer_.light_of(triangle);
    return light != nullptr && light->doubtful.empty();
  }

  void remember(const TileLook& look) {
    t_s_ = look.t_s;
    triangles_ = look.triangles;
    inverse_depths_ =
        tracer_.inverse_depths(directions_, {triangles_.data(), directions_.size()}, t_s_);
  }

  const EventWorld& world_;
  Tile tile_;
  std::span<const Eigen::Vector3d> directions_;
  std::array<Eigen::Vector3d, 4> outline_;
  double tolerance_s_;
  DirectionLanes lanes_;  ///< for one ray per pixel
  bool is_bilinear_;
  RayTracer tracer_;
  bool is_alone_ = false;  ///< the triangle that is seen, within the slab
  bool foresees_ = false;  ///< all that can come into view within the slab
  double t_s_ = 0;         ///< up to which the tile has sensed
  InverseDepthRange inverse_depths_;
  Triangles triangles_{};  ///< seen at t_s_
  std::array<TilePixel, kTilePixels> pixels_;
  Foresight foresight_;
  std::vector<double> passing_s_;  ///< of the pixel that is at work
  std::vector<double> shadow_s_;   ///< of a stretch of it
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
