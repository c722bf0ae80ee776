#include "simulator/sensor/adaptive/line_judge.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "simulator/sensor/signal/linear_signal.h"

namespace saccade {
namespace {

/// Samples of one surface are at most so many texels apart: a texture is bilinear between four
/// texels, so that within this distance its extrema are few.
constexpr double kMaxTexels = 0.5;
/// Two triangles of one object are one surface where the depth changes by less than this from one
/// sample to the next, relative.
constexpr double kContinuousDepth = 0.02;
/// Where a pixel comes to see another surface without a crossing, the change is located to this
/// fraction of a short step: what is seen before and after may still cross.
constexpr double kChangeFraction = 0.03;
/// Before and after such a change the signal may be so many times as steep as before.
constexpr double kChangeMargin = 3;
/// The error of a line is estimated from the slope before it; it may be larger by this factor.
constexpr double kErrorMargin = 8;
/// The slope before a line may equal its own by chance: its error is at least this part of its
/// change.
constexpr double kLeastError = 0.2;
/// The photoreceptor's low pass needs all of the signal. A line that it is given may be wrong by
/// what the signal changes within a bracket, or by this part of a threshold, which delays no common
/// event by more [log units].
constexpr double kFilteredError = 2e-5;
/// Of the change, at least this part is taken for the error of such a line.
constexpr double kLeastFilteredError = 0.01;
/// Nearer to an end, relative to its length, an interval is not divided.
constexpr double kLeastFraction = 0.05;
/// Where a light flickers smoothly lines are at most this part of its period.
constexpr double kPeriodFraction = 1.0 / 16;
/// A light that jumps is sampled so far before and after [brackets].
constexpr double kAroundJump = 1e-3;
/// Below this rate a signal does not move [1/s].
constexpr double kLeastSlope = 1e-12;

/// Between its jumps a square wave is steady.
double longest_line_s(std::span<const Flicker> flickers) {
  double longest_s = std::numeric_limits<double>::infinity();
  for (const Flicker& flicker : flickers)
    if (flicker.options().waveform != Waveform::kSquare)
      longest_s = std::min(longest_s, kPeriodFraction * flicker.period_s());
  return longest_s;
}

}  // namespace

LineJudge::LineJudge(const Scene& scene, double bracket_s, const PixelNoise& noise,
                     std::size_t rays_per_pixel)
    : scene_(scene),
      bracket_s_(bracket_s),
      is_filtered_(noise.filter.on()),
      refractory_s_(noise.refractory_s),
      longest_line_s_(longest_line_s(scene.flickers())),
      is_animated_(scene.is_animated()),
      rays_per_pixel_(rays_per_pixel) {}

bool LineJudge::is_one_surface(const ViewSample& a, const ViewSample& b) const {
  if (a.triangles == b.triangles) return true;
  return a.triangle != kNothing && b.triangle != kNothing &&
         scene_.object(a.triangle) == scene_.object(b.triangle) &&
         std::abs(a.distance - b.distance) < kContinuousDepth * std::min(a.distance, b.distance);
}

bool LineJudge::is_continuous(const ViewSample& a, const ViewSample& b) const {
  return a.lights == b.lights && is_one_surface(a, b);
}

std::optional<double> LineJudge::first_kink_s(const ViewSample& from, const ViewSample& to) const {
  const auto first = scene_.first_kink_s(from.triangle, from.t_s, to.t_s);
  return first || from.triangle == to.triangle ? first
                                               : scene_.first_kink_s(to.triangle, from.t_s, to.t_s);
}

LineJudgement LineJudge::judge(const SignalSoFar& pixel, const ViewSample& next, double reset_s,
                               const Thresholds& thresholds, double step_s) const {
  const ViewSample& now = pixel.now;
  const double length_s = next.t_s - now.t_s;
  if (length_s <= bracket_s_) return {};
  const bool is_same = now.triangles == next.triangles && now.lights == next.lights;
  const bool needs_ray = !is_same || rays_per_pixel_ > 1;
  // At its end the reference is set to the signal of that time, which is therefore sampled.
  if (reset_s >= next.t_s && !is_filtered_) return {};
  if (reset_s > now.t_s + bracket_s_ && reset_s < next.t_s - bracket_s_)
    return {false, reset_s, needs_ray};
  if (const auto jump_s = first_jump(scene_.flickers(), now.t_s, next.t_s)) {
    const double around_s = kAroundJump * bracket_s_;
    if (*jump_s - around_s > now.t_s) return {false, *jump_s - around_s, needs_ray};
    if (*jump_s + around_s < next.t_s) return {false, *jump_s + around_s, needs_ray};
  }
  if (is_animated_)
    if (const auto kink_s = first_kink_s(now, next)) return {false, *kink_s, needs_ray};
  const double middle_s = 0.5 * (now.t_s + next.t_s);
  if (length_s > longest_line_s_) return {false, middle_s, needs_ray};
  const bool is_continuous_there = is_continuous(now, next);
  const double change = next.log_intensity - now.log_intensity;
  const double texel = now.level > 0 ? std::exp2(-now.level) : 1;
  if (is_continuous_there &&
      std::max(std::abs(next.x - now.x), std::abs(next.y - now.y)) * texel > kMaxTexels)
    return {false, middle_s, needs_ray};
  const double normal_texel = now.normal_level > 0 ? std::exp2(-now.normal_level) : 1;
  if (is_continuous_there &&
      std::max(std::abs(next.normal_x - now.normal_x), std::abs(next.normal_y - now.normal_y)) *
              normal_texel >
          kMaxTexels)
    return {false, middle_s, needs_ray};

  // How far the signal may be from the line in its middle: a parabola with the slope before it, or
  // any curve of the same change.
  const double slope = change / length_s;
  double error = is_continuous_there ? 0.25 * std::abs(change) : std::abs(change);
  if (is_continuous_there && pixel.has_slope)
    error = std::max(kErrorMargin * 0.25 * std::abs(slope - pixel.before_s) * length_s,
                     kLeastError * std::abs(change));
  if (is_filtered_) {
    const bool is_smooth = is_continuous_there && pixel.has_slope;
    const double filtered_error = is_smooth
                                      ? std::max(0.25 * std::abs(slope - pixel.before_s) * length_s,
                                                 kLeastFilteredError * std::abs(change))
                                      : error;
    const double tolerated = bracket_s_ * std::abs(slope);
    if (filtered_error > std::max(tolerated, kFilteredError)) return {false, middle_s, needs_ray};
  }

  const Band& band = thresholds.band();
  const double from = thresholds.signal(LinearSample{now.t_s, now.log_intensity});
  const double to = thresholds.signal(LinearSample{next.t_s, next.log_intensity});
  if (band.contains(to)) {
    const double margin =
        std::min(band.upper - std::max(from, to), std::min(from, to) - band.lower);
    if (!is_continuous_there) {
      // The signal may come nearer to the band's ends just before and just after the change.
      const bool is_clear = kChangeMargin * std::abs(pixel.before_s) * length_s <= margin &&
                            length_s <= kChangeFraction * step_s;
      return is_clear ? LineJudgement{} : LineJudgement{false, middle_s, true};
    }
    return error <= margin ? LineJudgement{} : LineJudgement{false, middle_s, needs_ray};
  }
  if (!is_continuous_there) return {false, middle_s, true};
  // At a fraction f of the line a parabola departs from it by 4 f (1 - f) of that in the middle.
  const double level = to >= band.upper ? band.upper : band.lower;
  // A signal that rests on the level has no place where it crosses it.
  const double fraction = to == from ? 0 : std::clamp((level - from) / (to - from), 0.0, 1.0);
  const double middle_error_s = error / std::max(std::abs(slope), kLeastSlope);
  const auto is_exact = [&](double f) {
    return 2 * 4 * f * (1 - f) * middle_error_s <= bracket_s_;
  };
  if (!is_exact(fraction))
    return {false, now.t_s + std::clamp(fraction, kLeastFraction, 1 - kLeastFraction) * length_s,
            needs_ray};
  const double reset = fraction + refractory_s_ / length_s;
  if (refractory_s_ > 0 && reset * length_s < length_s - bracket_s_ && !is_exact(reset))
    return {false, now.t_s + reset * length_s, needs_ray};
  // A line across several thresholds.
  const double contrast = 0.5 * (band.upper - band.lower);
  if (std::abs(to - level) >= contrast && !is_exact(0.5)) return {false, middle_s, needs_ray};
  return {};
}

bool LineJudge::is_quiet(const SignalSoFar& pixel, const ViewSample& next,
                         const Thresholds& thresholds) {
  const ViewSample& now = pixel.now;
  const double length_s = next.t_s - now.t_s;
  const double texels = std::max(std::abs(next.x - now.x), std::abs(next.y - now.y));
  if (!pixel.has_slope || texels > kMaxTexels) return false;
  const double change = next.log_intensity - now.log_intensity;
  const double error = std::max(kErrorMargin * 0.25 * std::abs(change - pixel.before_s * length_s),
                                kLeastError * std::abs(change));
  const double from = thresholds.signal(LinearSample{now.t_s, now.log_intensity});
  const double to = thresholds.signal(LinearSample{next.t_s, next.log_intensity});
  const double high = std::max(from, to);
  const double low = std::min(from, to);
  return error <= std::min(thresholds.band().upper - high, low - thresholds.band().lower);
}

}  // namespace saccade
