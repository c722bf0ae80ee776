#pragma once

#include <algorithm>
#include <cmath>

#include "simulator/sensor/rays/plane_sampler.h"
#include "simulator/sensor/signal/cell_bounds.h"

namespace saccade {

/// One coordinate of the path of a ray over a plane during an interval of time, u = 0..1: the cubic
/// with the ends' values and slopes, plus 16 quartic u^2 (1 - u)^2, which puts the middle right.
class TrajectoryCoordinate {
 public:
  /// Values [texel] and slopes over u [texel] at both ends and in the middle.
  TrajectoryCoordinate(double from, double from_slope, double middle, double middle_slope,
                       double to, double to_slope)
      : from_(from),
        to_(to),
        chord_(to - from),
        from_excess_(from_slope - chord_),
        to_excess_(to_slope - chord_),
        quartic_(middle - from - 0.5 * chord_ - 0.125 * (from_excess_ - to_excess_)),
        // The next term of the path, c u^2 (1 - u)^2 (u - 1/2), has the slope c / 16 in the middle
        // and stays below 0.00895 c.
        error_(16 * 0.00895 * std::abs(middle_slope - slope_at(0.5))) {}

  [[nodiscard]] double from() const { return from_; }
  [[nodiscard]] double to() const { return to_; }
  [[nodiscard]] double chord() const { return chord_; }
  [[nodiscard]] double quartic() const { return quartic_; }
  /// Whether the path may be farther from the true one than `limit` [texel]: by its next term, or,
  /// lest that is small by chance, by what the terms before it let expect of a swinging motion:
  ///   0.2 quartic sqrt(quartic / bow)
  [[nodiscard]] bool may_exceed(double limit) const {
    const double quartic = std::abs(quartic_);
    const double bow = std::max(0.125 * std::abs(from_excess_ - to_excess_), quartic);
    return error_ > limit || 0.04 * quartic * quartic * quartic > limit * limit * bow;
  }

  [[nodiscard]] double at(double u) const {
    const double v = 1 - u;
    return from_ + u * (chord_ + v * (v * from_excess_ - u * to_excess_ + 16 * quartic_ * u * v));
  }
  [[nodiscard]] double slope_at(double u) const {
    const double v = 1 - u;
    return chord_ + v * (1 - 3 * u) * from_excess_ + u * (3 * u - 2) * to_excess_ +
           32 * quartic_ * u * v * (v - u);
  }

  /// The slopes at both ends.
  [[nodiscard]] double from_slope() const { return chord_ + from_excess_; }
  [[nodiscard]] double to_slope() const { return chord_ + to_excess_; }

  /// Bound of the second derivative: those of the weights stay within 4, 4 and 32.
  [[nodiscard]] double second_derivative_bound() const {
    return 4 * (std::abs(from_excess_) + std::abs(to_excess_)) + 32 * std::abs(quartic_);
  }

 private:
  double from_, to_;
  double chord_;
  double from_excess_, to_excess_;
  double quartic_;
  double error_;
};

/// Bounds on a part of the path.
struct CoordinateBounds {
  double from, to;
  double from_slope, to_slope;
  Interval values, slopes;

  /// All of it.
  explicit CoordinateBounds(const TrajectoryCoordinate& track)
      : CoordinateBounds(track.from(), track.from_slope(), track.to(), track.to_slope(),
                         track.second_derivative_bound()) {}
  CoordinateBounds(const TrajectoryCoordinate& track, double u0, double u1)
      : CoordinateBounds(track.at(u0), track.slope_at(u0), track.at(u1), track.slope_at(u1),
                         track.second_derivative_bound() * (u1 - u0), u1 - u0) {}

  /// Of all or a part of a path; whatever is asked of the whole does not depend on its cubic.
  [[nodiscard]] static CoordinateBounds over(const TrajectoryCoordinate& track, double u0,
                                             double u1) {
    return u0 == 0 && u1 == 1 ? CoordinateBounds(track) : CoordinateBounds(track, u0, u1);
  }

  [[nodiscard]] double middle_texel() const { return std::floor(0.5 * (values.low + values.high)); }

 private:
  /// `bending`: how much the slope may change at most over the part, which is `length` long.
  CoordinateBounds(double start, double start_slope, double end, double end_slope, double bending,
                   double length = 1)
      : from(start), to(end), from_slope(start_slope), to_slope(end_slope) {
    const double half_bend = 0.5 * bending;
    const double chord_error = 0.25 * half_bend * length;
    values = {std::min(from, to) - chord_error, std::max(from, to) + chord_error};
    slopes = {std::min(start_slope, end_slope) - half_bend,
              std::max(start_slope, end_slope) + half_bend};
  }
};

/// The path of a ray over the texture of a plane.
struct TexelTrajectory {
  TrajectoryCoordinate x, y;
  double from_s, length_s;

  [[nodiscard]] double time_s(double u) const { return from_s + u * length_s; }
  [[nodiscard]] double fraction(double t_s) const { return (t_s - from_s) / length_s; }

  /// Whether the path is as exact as times are wanted to be: its error is a small fraction of what
  /// the image moves within `tolerance_s`.
  [[nodiscard]] bool is_exact(double tolerance_s) const {
    constexpr double kFraction = 0.01;
    constexpr double kLeast_texel = 1e-6;
    const double motion = std::max(std::abs(x.chord()), std::abs(y.chord())) / length_s;
    const double limit = std::max(kFraction * tolerance_s * motion, kLeast_texel);
    return !x.may_exceed(limit) && !y.may_exceed(limit);
  }
};

}  // namespace saccade
