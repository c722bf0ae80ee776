#include "simulator/sensor/event_tile.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "core/check.h"
#include "simulator/sensor/rays/tile_samples.h"
#include "simulator/sensor/signal/linear_signal.h"
#include "simulator/sensor/signal/pixel_signal.h"
#include "simulator/sensor/signal/texture_signal.h"
#include "simulator/sensor/signal/tile_trajectories.h"
#include "simulator/sensor/visibility/visibility_predictor.h"

namespace saccade {
namespace {

/// Around a tile, for what a proof over some instants of a slice leaves out between them [px].
constexpr double kMargin_px = 0.5;
/// Longer steps, in multiples of max_step_px, where visibility is proven and the paths over the
/// texture alone set the pace.
constexpr double kLongSteps = 2;

/// Nearer than this to an edge a pixel's view may change [px].
constexpr double kEdgeMargin_px = 0.05;

/// So far from the change of what a pixel sees, or of a light, it is seen on both sides
/// [tolerances].
constexpr double kAroundChange = 0.45;

template <std::size_t kRays>
class LockstepTile final : public EventTile {
 public:
  LockstepTile(const TileContext& context, std::size_t index)
      : EventTile(
            PixelBank(context.options, context.noise, context.seed, context.rays.tile(index))),
        context_(context),
        directions_(context.rays.rays(index)),
        outline_(context.rays.outline(index, kMargin_px)),
        tolerance_s_(1e-6 * context.options.time_tolerance_us),
        lanes_(directions_.first(pixels_.size())),
        is_bilinear_(context.options.texture_filter == TextureFilter::kBilinear),
        tracer_(context.scene, statistics_, footprints(context)),
        predictor_(context.scene, tracer_, outline_, kEdgeMargin_px / context.rays.camera().fx,
                   tolerance_s_) {}

  void start(const SplineTable& poses, double t_s) override {
    tracer_.set_poses(poses);
    TileSamples now;
    now.trace(tracer_, directions_, t_s, all_pixels());
    now.sample_surfaces(tracer_, directions_, all_pixels());
    for (std::size_t i = 0; i < pixels_.size(); ++i)
      pixels_.start(i, sample(now, i).log_intensity, t_s);
    store_state(now);
  }

  void advance(const TimeSlice& slice, const TileMotion& motion) override {
    exchange_memory();
    tracer_.set_poses(slice.poses);
    if (predict_visibility(slice.end_s, motion)) {
      advance_to(slice.end_s, motion);
    } else {
      // Fewer triangles come within reach in half the time.
      const double middle_s = 0.5 * (t_s_ + slice.end_s);
      TileMotion half = motion;
      half.pixels *= 0.5;
      for (const double end_s : {middle_s, slice.end_s}) {
        predict_visibility(end_s, half);
        advance_to(end_s, half);
      }
    }
    exchange_memory();
  }

  [[nodiscard]] InverseDepthRange inverse_depths() const override { return inverse_depths_; }

  void save(StateWriter& state) const override {
    state.value(t_s_);
    state.value(inverse_depths_.low);
    state.value(inverse_depths_.high);
    state.value(triangles_);
    pixels_.save(state);
    state.value(statistics_);
  }

  void load(StateReader& state) override {
    state.value(t_s_);
    state.value(inverse_depths_.low);
    state.value(inverse_depths_.high);
    state.value(triangles_);
    pixels_.load(state);
    state.value(statistics_);
  }

 private:
  using Signal = PixelSignal<kRays>;
  using Sample = PixelSample<kRays>;
  using TileSamples = saccade::TileSamples<kRays>;
  using Triangles = typename TileSamples::Triangles;

  /// Some of the equal steps through a slice.
  struct Steps {
    double from_s, to_s;  ///< of the slice
    int count;            ///< in the slice
    int first, last;      ///< times of these steps
    std::size_t depth;    ///< halvings that led to them

    [[nodiscard]] double time_s(int k) const {
      return k == count ? to_s : from_s + (to_s - from_s) * k / count;
    }
    [[nodiscard]] Steps part(int from, int to) const {
      return {from_s, to_s, count, from, to, depth + 1};
    }
  };

  [[nodiscard]] static const PixelRays* footprints(const TileContext& context) {
    return context.options.texture_filter == TextureFilter::kMipmap ? &context.rays : nullptr;
  }

  /// What a tile has collected is of no use once it has advanced, but its memory is to the next one
  /// of the same thread: thousands of tiles would hold hundreds of megabytes.
  void exchange_memory() {
    thread_local RayTracer::Memory of_tracer;
    thread_local VisibilityPredictor::Memory of_predictor;
    tracer_.swap(of_tracer);
    predictor_.swap(of_predictor);
  }

  /// Finds out what can come into view up to `end_s`: whether that is known.
  bool predict_visibility(double end_s, const TileMotion& motion) {
    tracer_.set_region(outline_, t_s_, end_s);
    sees_one_triangle_ = !motion.has_objects && sees_one_triangle(end_s);
    if (sees_one_triangle_) predictor_.clear();
    is_predicted_ = !sees_one_triangle_ && predictor_.collect(motion.farthest_m, t_s_, end_s);
    return sees_one_triangle_ || is_predicted_;
  }

  void advance_to(double end_s, const TileMotion& motion) {
    const double step_px = context_.options.max_step_px * (sees_one_triangle_ ? kLongSteps : 1);
    const double step_divisor = sees_one_triangle_ || is_predicted_ ? 1 : motion.step_divisor;
    const int count =
        std::max(1, static_cast<int>(std::ceil(step_divisor * motion.pixels / step_px)));
    TileSamples now, next;
    // Seen again, so that a tile that was loaded goes on exactly as the one that was saved.
    now.set_triangles(triangles_, t_s_);
    sample_at(end_s, next, all_pixels());
    sense_between({t_s_, end_s, count, 0, count, 0}, now, next, all_pixels());
    store_state(next);
  }

  [[nodiscard]] PixelSet all_pixels() const { return ~0ULL >> (64 - pixels_.size()); }

  /// With rays, if it takes any.
  void sample_at(double t_s, TileSamples& now, const PixelSet& pixels) {
    sees_one_triangle_ ? now.set_triangles(triangles_, t_s)
                       : now.trace(tracer_, directions_, t_s, pixels);
  }

  /// Senses `pixels` between two samples: at once where they see one surface all the time, else in
  /// the two halves of the steps.
  void sense_between(const Steps& steps, TileSamples& now, TileSamples& next, PixelSet pixels) {
    predictor_.restrict_to(now.t_s, next.t_s, steps.depth);
    if (kRays == 1 && is_bilinear_ && (sees_one_triangle_ || predictor_.has_candidates()))
      pixels = sense_steady(now, next, pixels);
    if (pixels.none()) return;
    if (steps.last - steps.first == 1) {
      now.sample_surfaces(tracer_, directions_, pixels);
      next.sample_surfaces(tracer_, directions_, pixels);
      return sense_step(now, next, pixels);
    }
    const int middle = (steps.first + steps.last) / 2;
    TileSamples between;
    sample_at(steps.time_s(middle), between, pixels);
    sense_between(steps.part(steps.first, middle), now, between, pixels);
    sense_between(steps.part(middle, steps.last), between, next, pixels);
  }

  /// Senses those pixels that see one textured plane all the time, or one and then another. Returns
  /// the others.
  PixelSet sense_steady(const TileSamples& now, const TileSamples& next, PixelSet pixels) {
    TileTrajectories paths(tracer_, lanes_, now.t_s, next.t_s);
    for (std::size_t i = 0; i < pixels_.size(); ++i) {
      if (!pixels[i]) continue;
      const TriangleId from = now.triangles[i];
      const TriangleId to = next.triangles[i];
      if (!tracer_.is_plane(from) || !tracer_.is_plane(to)) continue;
      if (from == to ? sense_plane(i, from, paths) : sense_change(i, from, to, paths))
        pixels.reset(i);
    }
    return pixels;
  }

  /// Whether a pixel sees just the plane of a triangle; it is sensed then.
  bool sense_plane(std::size_t i, TriangleId triangle, TileTrajectories& paths) {
    if (!sees_one_triangle_ && !predictor_.stays_visible(directions_[i], triangle)) return false;
    const PlaneTrajectories& trajectories = paths.over(triangle);
    const TexelTrajectory path = trajectories.of_pixel(i);
    if (!is_usable(trajectories, path)) return false;
    sense_path(i, path, trajectories.surface, paths.from_s, paths.to_s);
    return true;
  }

  /// The same for the planes of two, one after the other; from right before the change to right
  /// after it along a line.
  bool sense_change(std::size_t i, TriangleId from, TriangleId to, TileTrajectories& paths) {
    if (sees_one_triangle_) return false;
    const double change_s =
        predictor_.change_s(directions_[i], {from, paths.from_s}, {to, paths.to_s});
    const double before_s = change_s - kAroundChange * tolerance_s_;
    const double after_s = change_s + kAroundChange * tolerance_s_;
    if (!(before_s > paths.from_s && after_s < paths.to_s)) return false;
    const PlaneTrajectories& first = paths.over(from);
    const TexelTrajectory path = first.of_pixel(i);
    if (!is_usable(first, path)) return false;
    const PlaneTrajectories& second = paths.over(to);
    const TexelTrajectory next_path = second.of_pixel(i);
    if (!is_usable(second, next_path)) return false;
    sense_path(i, path, first.surface, paths.from_s, before_s);
    sense(i, LinearSignal(context_.options.log_eps, tolerance_s_),
          seen_at(before_s, path, first.surface), seen_at(after_s, next_path, second.surface));
    sense_path(i, next_path, second.surface, after_s, paths.to_s);
    return true;
  }

  [[nodiscard]] LinearSample seen_at(double t_s, const TexelTrajectory& path,
                                     const SurfaceSample& surface) const {
    const double u = path.fraction(t_s);
    const SurfaceSample seen{surface.texture, path.x.at(u), path.y.at(u), surface.factor};
    return {t_s, log_intensity(seen.radiance(), context_.options.log_eps)};
  }

  [[nodiscard]] bool is_usable(const PlaneTrajectories& trajectories,
                               const TexelTrajectory& path) const {
    return trajectories.surface.texture != nullptr && path.is_exact(tolerance_s_);
  }

  void sense_path(std::size_t i, const TexelTrajectory& path, const SurfaceSample& surface,
                  double from_s, double to_s) {
    if (pixels_.is_idle(i, from_s, to_s) && is_certified(i, path, surface, from_s, to_s)) return;
    const TextureSignal plane(path, surface, context_.options.log_eps, tolerance_s_);
    const bool is_known = pixels_.is_noisy();
    sense(i, plane, plane.sample_at(from_s, is_known), plane.sample_at(to_s, is_known));
  }

  void sense_step(const TileSamples& now, const TileSamples& next, const PixelSet& pixels) {
    for (std::size_t i = 0; i < pixels_.size(); ++i) {
      if (!pixels[i]) continue;
      if (any_transit(i, now, next))
        sense_transits(i, sample(now, i), sample(next, i));
      else if (!pixels_.is_idle(i, now.t_s, next.t_s) || !is_certified(i, now, next) ||
               any_shadow_transit(i, sample(now, i), sample(next, i)))
        sense_lit(i, signal(i), sample(now, i), sample(next, i));
    }
  }

  [[nodiscard]] Signal signal(std::size_t i) {
    return Signal(tracer_, directions_.subspan(i * kRays).template first<kRays>(),
                  context_.options.log_eps, tolerance_s_);
  }

  [[nodiscard]] Sample sample(const TileSamples& now, std::size_t i) const {
    return now.sample(i, context_.options.log_eps);
  }

  template <class AnySignal, class AnySample>
  void sense(std::size_t i, const AnySignal& pixel_signal, const AnySample& lo,
             const AnySample& hi) {
    const double width_s = pixels_.sense(i, pixel_signal, lo, hi);
    statistics_.time_bound_s = std::max(statistics_.time_bound_s, width_s);
  }

  /// Collects the times, in order, at which a pixel must be sampled to see what passes between two
  /// samples; whether there are any.
  [[nodiscard]] bool any_transit(std::size_t i, const TileSamples& now, const TileSamples& next) {
    transit_times_s_.clear();
    if (!predictor_.has_candidates()) return false;
    predictor_.select_rays(directions_.subspan(i * kRays, kRays));
    for (std::size_t k = i * kRays; k < (i + 1) * kRays; ++k)
      predictor_.find_transits(directions_[k], {now.t_s, now.samples[k]},
                               {next.t_s, next.samples[k]}, transit_times_s_);
    std::sort(transit_times_s_.begin(), transit_times_s_.end());
    return !transit_times_s_.empty();
  }

  /// sense() with samples at transit_times_s_.
  void sense_transits(std::size_t i, Sample lo, const Sample& hi) {
    const Signal pixel_signal = signal(i);
    for (const double t_s : transit_times_s_) {
      if (t_s - lo.t_s < tolerance_s_ || hi.t_s - t_s < tolerance_s_) continue;
      const Sample middle = pixel_signal.trace(t_s);
      sense_lit(i, pixel_signal, lo, middle);
      lo = middle;
    }
    sense_lit(i, pixel_signal, lo, hi);
  }

  /// sense() with samples around the times at which shadows come or go, and at those at which
  /// flickering lights jump or turn.
  void sense_lit(std::size_t i, const Signal& pixel_signal, Sample lo, const Sample& hi) {
    const bool is_divided = any_shadow_transit(i, lo, hi);
    if (any_flicker_break(lo.t_s, hi.t_s) || is_divided) {
      for (const double t_s : shadow_times_s_) {
        if (!(t_s > lo.t_s && t_s < hi.t_s)) continue;
        const Sample middle = pixel_signal.resample(t_s, lo, hi);
        sense(i, pixel_signal, lo, middle);
        lo = middle;
      }
    }
    sense(i, pixel_signal, lo, hi);
  }

  /// The same for shadows.
  [[nodiscard]] bool any_shadow_transit(std::size_t i, const Sample& lo, const Sample& hi) {
    shadow_times_s_.clear();
    if (!tracer_.is_lit()) return false;
    for (std::size_t k = 0; k < kRays; ++k)
      predictor_.find_shadows(directions_[i * kRays + k], {lo.rays[k].triangle, lo.t_s},
                              {hi.rays[k].triangle, hi.t_s}, shadow_times_s_);
    std::sort(shadow_times_s_.begin(), shadow_times_s_.end());
    return !shadow_times_s_.empty();
  }

  /// Adds the times at which a flickering light jumps or turns to shadow_times_s_, in order;
  /// whether there are any.
  [[nodiscard]] bool any_flicker_break(double from_s, double to_s) {
    const std::span<const Flicker> flickers = context_.scene.flickers();
    if (flickers.empty()) return false;
    for (const Flicker& flicker : flickers)
      flicker.find_breaks(from_s, to_s, kAroundChange * tolerance_s_, shadow_times_s_);
    std::sort(shadow_times_s_.begin(), shadow_times_s_.end());
    return !shadow_times_s_.empty();
  }

  /// Whether the bounds of the radiance prove that nothing crosses.
  [[nodiscard]] bool is_certified(std::size_t i, const TileSamples& now,
                                  const TileSamples& next) const {
    RadianceRange sum{0, 0, 0, 0};
    for (std::size_t k = i * kRays; k < (i + 1) * kRays; ++k) {
      const RaySample& from = now.samples[k];
      const RaySample& to = next.samples[k];
      if (from.triangle != to.triangle) return false;
      sum.add(tracer_.radiance_range(directions_[k], from, now.t_s, to, next.t_s));
    }
    sum.scale(1.0 / kRays);
    return pixels_.thresholds(i).certify(sum, next.t_s);
  }

  /// The same along a part of a path.
  [[nodiscard]] bool is_certified(std::size_t i, const TexelTrajectory& path,
                                  const SurfaceSample& surface, double from_s, double to_s) const {
    const double from = path.fraction(from_s);
    const double to = path.fraction(to_s);
    const Interval x = CoordinateBounds::over(path.x, from, to).values;
    const Interval y = CoordinateBounds::over(path.y, from, to).values;
    const TexelRange texels = surface.texture->range({x.low, x.high, y.low, y.high});
    const double low = surface.factor * static_cast<double>(texels.low);
    const double high = surface.factor * static_cast<double>(texels.high);
    const Interval inside = pixels_.thresholds(i).radiances(to_s);
    return low > inside.low && high < inside.high;
  }

  [[nodiscard]] bool are_equal(const Triangles& triangles) const {
    const auto end = triangles.begin() + static_cast<std::ptrdiff_t>(directions_.size());
    return std::all_of(triangles.begin(), end, [&](TriangleId t) { return t == triangles[0]; });
  }

  /// Whether one triangle, in even light, is all that can be seen in and around the tile up to
  /// `t_s`.
  [[nodiscard]] bool sees_one_triangle(double t_s) {
    return are_equal(triangles_) && tracer_.is_sole_visible(triangles_[0], outline_, t_s_, t_s) &&
           is_evenly_lit(triangles_[0]);
  }

  [[nodiscard]] bool is_evenly_lit(TriangleId triangle) {
    if (!tracer_.is_lit() || triangle == kNothing) return true;
    const PatchLighting* lighting = tracer_.lighting_of(triangle);
    return lighting != nullptr && lighting->partly_occluded.empty();
  }

  void store_state(const TileSamples& now) {
    t_s_ = now.t_s;
    triangles_ = now.triangles;
    inverse_depths_ =
        tracer_.inverse_depths(directions_, {triangles_.data(), directions_.size()}, t_s_);
  }

  const TileContext& context_;
  std::span<const Eigen::Vector3d> directions_;
  std::array<Eigen::Vector3d, 4> outline_;
  double tolerance_s_;
  DirectionLanes lanes_;  ///< for one ray per pixel
  bool is_bilinear_;
  RayTracer tracer_;
  bool sees_one_triangle_ = false;  ///< the triangle that is seen, within the slice
  bool is_predicted_ = false;       ///< all that can come into view within the slice
  double t_s_ = 0;                  ///< up to which the tile has sensed
  InverseDepthRange inverse_depths_;
  Triangles triangles_{};  ///< seen at t_s_
  VisibilityPredictor predictor_;
  std::vector<double> transit_times_s_;  ///< of the pixel that is at work
  std::vector<double> shadow_times_s_;   ///< of an interval of it, and where the light breaks
};

}  // namespace

std::unique_ptr<EventTile> make_event_tile(const TileContext& context, std::size_t index) {
  switch (context.rays.rays_per_pixel()) {
    case 1:
      return std::make_unique<LockstepTile<1>>(context, index);
    case 4:
      return std::make_unique<LockstepTile<4>>(context, index);
    case 16:
      return std::make_unique<LockstepTile<16>>(context, index);
    default:
      SACCADE_CHECK(false);
      return nullptr;
  }
}

}  // namespace saccade
