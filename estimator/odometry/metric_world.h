#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "core/io/covariance_file.h"
#include "estimator/imu/inertial_alignment.h"
#include "estimator/odometry/keyframe.h"
#include "estimator/tracking/edges/edge_tracker.h"

namespace saccade {

/// Whether the accelerometer says how long a metre is and where down is (group `imu`).
struct MetricWorldOptions {
  bool align = false;
  double position_sigma = 1e-3;  ///< of a pose, from one interval to the next, over typical depth
  InertialAlignmentOptions alignment;
};

/// Aligns the poses that are not lost with the readings. The typical depth is the keyframes'.
[[nodiscard]] InertialAlignment align_odometry(std::span<const TrackedPose> poses,
                                               std::span<const Keyframe> keyframes,
                                               const MountedImu& imu,
                                               const MetricWorldOptions& options);

/// Brings what odometry found into metres and a world whose z axis points up, turned the shortest
/// way about the world's origin. `found` is kOk (contract).
void take_into_metric_world(const InertialAlignment& found, std::span<TrackedPose> poses,
                            std::span<Keyframe> keyframes,
                            std::span<StampedCovariance> covariances);

/// Writes inertial.yaml: what the readings say of a run's path, and whether the run was brought
/// into that world.
void write_inertial_alignment(const std::filesystem::path& file, const InertialAlignment& found,
                              bool applied);

}  // namespace saccade
