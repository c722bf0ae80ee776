#pragma once

#include "core/trajectory.h"

namespace saccade {

/// How much recorded poses jitter from one to the next, as motion capture does; motion that is smooth
/// over five poses counts for nothing.
struct PoseNoise {
  double rotation_rad = 0;  ///< standard deviation of a pose's orientation, per axis
  double position_m = 0;    ///< of its position, per axis
  double spacing_s = 0;     ///< median time between poses

  /// How many poses are averaged over a time, at least 1.
  [[nodiscard]] double poses_within(double duration_s) const;
};

/// From each pose's distance from the cubic through its four neighbours, by the median; zero for
/// fewer than five poses.
[[nodiscard]] PoseNoise pose_noise_of(const Trajectory& trajectory);

/// The same motion as a cubic spline with knots `knot_spacing_s` apart, fitted by least squares
/// (Spline::smooth) and sampled every millisecond and at the given poses' times; gaps longer than
/// four knots stay straight. At least 2 poses. Throws InputError where the rotations do not converge.
[[nodiscard]] Trajectory smoothed(const Trajectory& trajectory, double knot_spacing_s);

}  // namespace saccade
