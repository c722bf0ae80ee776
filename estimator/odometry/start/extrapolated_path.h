#pragma once

#include <vector>

#include "core/trajectory.h"
#include "estimator/tracking/gyroscope.h"

namespace saccade {

/// Spacing of the poses of extrapolated paths [s].
inline constexpr double kPoseSpacing_s = 1e-3;

/// Replaces the rotations of the poses from `first` >= 1 on by the integral of the gyroscope's
/// rates, if it is not empty.
void rotate_by(const Gyroscope& gyroscope, std::vector<StampedPose>& poses, std::size_t first);

/// `path` extrapolated at the constant velocity of its last 20 ms, or of all of it where it is
/// shorter, until `until_s` or just beyond; `gyroscope`, where it is not empty, measures the
/// rotation.
[[nodiscard]] Trajectory extrapolated(const Trajectory& path, double until_s,
                                      const Gyroscope& gyroscope);

}  // namespace saccade
