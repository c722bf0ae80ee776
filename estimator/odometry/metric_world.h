#pragma once

#include <filesystem>
#include <span>

#include "core/io/covariance_file.h"
#include "estimator/imu/inertial_alignment.h"
#include "estimator/odometry/keyframe.h"
#include "estimator/tracking/tracker.h"

namespace saccade {

/// Aligns the poses that are kOk, neither lost nor relocalised, with the samples of the sensor. The typical depth is the keyframes'.
[[nodiscard]] InertialAlignment align_odometry(std::span<const TrackedPose> poses,
                                               std::span<const Keyframe> keyframes,
                                               const MountedImu& imu);

/// A pose in metres and a world whose z axis points up, rotated the shortest way about the world's
/// origin: gravity_alignment() * (s t, R).
[[nodiscard]] Rigid3 in_metric_world(const InertialAlignment& found,
                                     const Rigid3& world_from_camera);

/// Transforms what odometry found by in_metric_world(). `found` is kOk (contract).
void transform_to_metric_world(const InertialAlignment& found, std::span<TrackedPose> poses,
                               std::span<Keyframe> keyframes,
                               std::span<StampedCovariance> covariances);

/// Writes inertial.yaml: what the samples say of a run's path, and whether the run was brought
/// into that world.
void write_inertial_alignment(const std::filesystem::path& file, const InertialAlignment& found,
                              bool applied);

}  // namespace saccade
