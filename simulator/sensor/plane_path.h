#pragma once

#include <algorithm>
#include <cmath>

#include "simulator/sensor/texel_path.h"

namespace saccade {

/// One coordinate of the path of a ray over a plane during a stretch of time, u = 0..1: the cubic
/// with the ends' values and slopes, plus 16 swell u^2 (1 - u)^2, which puts the middle right.
class PlaneTrack {
 public:
  /// Values [texel] and slopes over u [texel] at both ends and half way.
  PlaneTrack(double from, double from_slope, double middle, double middle_slope, double to,
             double to_slope)
      : from_(from),
        to_(to),
        chord_(to - from),
        from_excess_(from_slope - chord_),
        to_excess_(to_slope - chord_),
        swell_(middle - from - 0.5 * chord_ - 0.125 * (from_excess_ - to_excess_)),
        // The next term of the path, c u^2 (1 - u)^2 (u - 1/2), has the slope c / 16 half way and
        // stays below 0.00895 c.
        error_(16 * 0.00895 * std::abs(middle_slope - slope_at(0.5))) {}

  [[nodiscard]] double from() const { return from_; }
  [[nodiscard]] double to() const { return to_; }
  [[nodiscard]] double chord() const { return chord_; }
  /// How far the path may be from the true one [texel].
  [[nodiscard]] double error() const { return error_; }

  [[nodiscard]] double at(double u) const {
    const double v = 1 - u;
    return from_ + u * (chord_ + v * (v * from_excess_ - u * to_excess_ + 16 * swell_ * u * v));
  }
  [[nodiscard]] double slope_at(double u) const {
    const double v = 1 - u;
    return chord_ + v * (1 - 3 * u) * from_excess_ + u * (3 * u - 2) * to_excess_ +
           32 * swell_ * u * v * (v - u);
  }

  /// Bound of the second derivative: those of the weights stay within 4, 4 and 32.
  [[nodiscard]] double bend() const {
    return 4 * (std::abs(from_excess_) + std::abs(to_excess_)) + 32 * std::abs(swell_);
  }

 private:
  double from_, to_;
  double chord_;
  double from_excess_, to_excess_;
  double swell_;
  double error_;
};

/// Bounds on a part of the path.
struct TrackPart {
  double from, to;
  Interval values, slopes;

  TrackPart(const PlaneTrack& track, double u0, double u1) : from(track.at(u0)), to(track.at(u1)) {
    const double length = u1 - u0;
    const double turn = 0.5 * track.bend() * length;
    const double stray = 0.25 * turn * length;
    values = {std::min(from, to) - stray, std::max(from, to) + stray};
    const double a = track.slope_at(u0);
    const double b = track.slope_at(u1);
    slopes = {std::min(a, b) - turn, std::max(a, b) + turn};
  }

  [[nodiscard]] double middle_texel() const { return std::floor(0.5 * (values.low + values.high)); }
};

/// The path of a ray over the texture of a plane.
struct PlanePath {
  PlaneTrack x, y;
  double from_s, length_s;

  /// What the ray sees at both ends of the stretch and half way.
  PlanePath(double start_s, double seconds, const RayView& from, const RayView& middle,
            const RayView& to)
      : x(from.look.x, from.x_rate * seconds, middle.look.x, middle.x_rate * seconds, to.look.x,
          to.x_rate * seconds),
        y(from.look.y, from.y_rate * seconds, middle.look.y, middle.y_rate * seconds, to.look.y,
          to.y_rate * seconds),
        from_s(start_s),
        length_s(seconds) {}

  [[nodiscard]] double time_s(double u) const { return from_s + u * length_s; }
  [[nodiscard]] double fraction(double t_s) const { return (t_s - from_s) / length_s; }

  /// Whether the path is as exact as times are wanted to be: its error is a small share of what the
  /// image moves within `tolerance_s`.
  [[nodiscard]] bool is_exact(double tolerance_s) const {
    constexpr double kShare = 0.02;
    constexpr double kLeast_texel = 1e-6;
    const double motion = std::max(std::abs(x.chord()), std::abs(y.chord())) / length_s;
    return std::max(x.error(), y.error()) <= std::max(kShare * tolerance_s * motion, kLeast_texel);
  }
};

}  // namespace saccade
