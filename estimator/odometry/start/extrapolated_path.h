#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "core/trajectory.h"
#include "estimator/tracking/gyroscope.h"

namespace saccade {

/// Spacing of the poses of extrapolated paths [s].
inline constexpr double kPoseSpacing_s = 1e-3;

/// Replaces the rotations of the poses from `first` >= 1 on by the integral of the gyroscope's
/// rates, if it is not empty.
inline void rotate_by(const Gyroscope& gyroscope, std::vector<StampedPose>& poses,
                      std::size_t first) {
  if (gyroscope.is_empty()) return;
  for (std::size_t i = first; i < poses.size(); ++i) {
    const StampedPose& before = poses[i - 1];
    const Eigen::Vector3d rate =
        gyroscope.mean_rate(ns_from_seconds(before.t_s), ns_from_seconds(poses[i].t_s));
    Rigid3& pose = poses[i].world_from_camera;
    pose = {before.world_from_camera.rotation() * so3_exp((poses[i].t_s - before.t_s) * rate),
            pose.translation()};
  }
}

/// `path` extrapolated at the constant velocity of its last 20 ms, or of all of it where it is
/// shorter, until `until_s` or just beyond; `gyroscope`, where it is not empty, measures the
/// rotation.
[[nodiscard]] inline Trajectory extrapolated(const Trajectory& path, double until_s,
                                             const Gyroscope& gyroscope) {
  constexpr double kLast_s = 0.02;
  const double end_s = path.end_s();
  const double last_s = std::min(kLast_s, end_s - path.start_s());
  const Rigid3 last = path.poses().back().world_from_camera;
  const Twist step = (path.at_clamped(end_s - last_s).inverse() * last).log();
  std::vector<StampedPose> poses(path.poses().begin(), path.poses().end());
  for (double t_s = end_s + kPoseSpacing_s; t_s < until_s + kPoseSpacing_s; t_s += kPoseSpacing_s)
    poses.push_back({t_s, last * Rigid3::exp((t_s - end_s) / last_s * step)});
  rotate_by(gyroscope, poses, path.size());
  return Trajectory(std::move(poses));
}

}  // namespace saccade
