#include "simulator/sensor/event_tile.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include "core/check.h"
#include "simulator/sensor/visibility/visibility_predictor.h"
#include "simulator/sensor/signal/pixel_signal.h"
#include "simulator/sensor/signal/texture_signal.h"
#include "simulator/sensor/rays/tile_samples.h"
#include "simulator/sensor/signal/tile_trajectories.h"

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

template <std::size_t kRays>
class LockstepTile final : public EventTile {
 public:
  LockstepTile(const EventWorld& world, std::size_t index)
      : EventTile(PixelBank(world.options, world.noise, world.seed, world.rays.tile(index))),
        world_(world),
        directions_(world.rays.rays(index)),
        outline_(world.rays.outline(index, kMargin_px)),
        tolerance_s_(1e-6 * world.options.time_tolerance_us),
        lanes_(directions_.first(pixels_.size())),
        is_bilinear_(world.options.texture_filter == TextureFilter::kBilinear),
        tracer_(world.scene, statistics_, footprints(world)),
        foresight_(world.scene, tracer_, outline_, kEdge_px / world.rays.camera().fx,
                   tolerance_s_) {}

  void start(const SplineTable& poses, double t_s) override {
    tracer_.use(poses);
    TileLook look;
    look.trace(tracer_, directions_, t_s, all_pixels());
    look.add_views(tracer_, directions_);
    for (std::size_t i = 0; i < pixels_.size(); ++i)
      pixels_.start(i, sample(look, i).log_intensity, t_s);
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
  using TileLook = saccade::TileLook<kRays>;
  using Triangles = typename TileLook::Triangles;

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
    look.see(triangles_, t_s_);
    look_at(end_s, next, all_pixels());
    sense_between({0, count, 0}, {t_s_, end_s, count}, look, next, all_pixels());
    remember(next);
  }

  [[nodiscard]] PixelSet all_pixels() const { return (1ULL << pixels_.size()) - 1; }

  /// With rays, if it takes any.
  void look_at(double t_s, TileLook& look, const PixelSet& pixels) {
    is_alone_ ? look.see(triangles_, t_s) : look.trace(tracer_, directions_, t_s, pixels);
  }

  /// Senses `pixels` between two looks: at once where they see one surface all the time, else in
  /// the two halves of the steps.
  void sense_between(const StepRange& range, const Steps& steps, TileLook& look, TileLook& next,
                     PixelSet pixels) {
    foresight_.narrow(look.t_s, next.t_s, range.depth);
    if (kRays == 1 && is_bilinear_ && (is_alone_ || foresight_.has_any()))
      pixels = sense_steady(look, next, pixels);
    if (pixels.none()) return;
    if (range.to - range.from == 1) {
      look.add_views(tracer_, directions_);
      next.add_views(tracer_, directions_);
      return sense_step(look, next, pixels);
    }
    const int middle = (range.from + range.to) / 2;
    TileLook between;
    look_at(steps(middle), between, pixels);
    sense_between({range.from, middle, range.depth + 1}, steps, look, between, pixels);
    sense_between({middle, range.to, range.depth + 1}, steps, between, next, pixels);
  }

  /// Senses those pixels that see one textured plane all the time, or one and then another. Returns
  /// the others.
  PixelSet sense_steady(const TileLook& look, const TileLook& next, PixelSet pixels) {
    TilePaths paths(tracer_, lanes_, look.t_s, next.t_s);
    for (std::size_t i = 0; i < pixels_.size(); ++i) {
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
    const TriangleCourse& course = paths.over(triangle);
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
    const TriangleCourse& first = paths.over(from);
    const PlanePath path = first.paths.path(i);
    if (!is_walkable(first, path)) return false;
    const TriangleCourse& second = paths.over(to);
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
    if (pixels_.is_idle(i, from_s, to_s) && is_certified(i, path, surface, from_s, to_s)) return;
    const PlaneSignal plane(path, surface, world_.options.log_eps, tolerance_s_);
    const bool is_known = pixels_.is_noisy();
    sense(i, plane, plane.place(from_s, is_known), plane.place(to_s, is_known));
  }

  void sense_step(const TileLook& look, const TileLook& next, const PixelSet& pixels) {
    for (std::size_t i = 0; i < pixels_.size(); ++i) {
      if (!pixels[i]) continue;
      if (any_passes(i, look, next))
        sense_passing(i, sample(look, i), sample(next, i));
      else if (!pixels_.is_idle(i, look.t_s, next.t_s) || !is_certified(i, look, next) ||
               any_shadow_passes(i, sample(look, i), sample(next, i)))
        sense_lit(i, signal(i), sample(look, i), sample(next, i));
    }
  }

  [[nodiscard]] Signal signal(std::size_t i) {
    return Signal(tracer_, directions_.subspan(i * kRays).template first<kRays>(),
                  world_.options.log_eps, tolerance_s_);
  }

  [[nodiscard]] Sample sample(const TileLook& look, std::size_t i) const {
    return look.sample(i, world_.options.log_eps);
  }

  template <class AnySignal, class AnySample>
  void sense(std::size_t i, const AnySignal& pixel_signal, const AnySample& lo,
             const AnySample& hi) {
    const double width_s = pixels_.sense(i, pixel_signal, lo, hi);
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
    return pixels_.thresholds(i).certify(sum, next.t_s);
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
    const Interval silent = pixels_.thresholds(i).radiances(to_s);
    return low > silent.low && high < silent.high;
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
  Foresight foresight_;
  std::vector<double> passing_s_;  ///< of the pixel that is at work
  std::vector<double> shadow_s_;   ///< of a stretch of it
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
