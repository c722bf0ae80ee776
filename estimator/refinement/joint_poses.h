#pragma once

#include <vector>

#include "core/io/covariance_file.h"
#include "estimator/refinement/joint_refinement.h"
#include "estimator/tracking/edges/edge_tracker.h"

namespace saccade {

/// The covariances of poses at their times, whose sigmas they become; none, and nothing changed,
/// where they are not determined.
[[nodiscard]] std::vector<StampedCovariance> take_sigmas(const JointResult& refined,
                                                         std::vector<TrackedPose>& poses);

}  // namespace saccade
