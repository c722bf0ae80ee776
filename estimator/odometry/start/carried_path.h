#pragma once

#include <vector>

#include "core/trajectory.h"
#include "estimator/tracking/gyroscope.h"

namespace saccade {

/// Between the poses of paths that are carried on [s].
inline constexpr double kPoseSpacing_s = 1e-3;

/// Replaces the turns of the poses from `first` >= 1 on by those that the gyroscope felt, if it is
/// not empty.
void turn_by(const Gyroscope& gyroscope, std::vector<StampedPose>& poses, std::size_t first);

/// `path` goes on at its velocity of the last 20 ms, or of all of it where it is shorter, until
/// `until_s` or just beyond; `gyroscope`, where it is not empty, tells the turn.
[[nodiscard]] Trajectory carried_on(const Trajectory& path, double until_s,
                                    const Gyroscope& gyroscope);

}  // namespace saccade
