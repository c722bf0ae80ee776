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

/// The acceleration at the end of given poses, and until when it may be taken to last.
struct PathAcceleration {
  Twist rate = Twist::Zero();  ///< of the twist in the camera [m/s^2, rad/s^2]
  double until_s = 0;
};

/// The acceleration of the last tenth of a second of `path`, or of all of it where it is shorter, by
/// least squares. It lasts for as long again.
[[nodiscard]] inline PathAcceleration last_acceleration(const Trajectory& path) {
  constexpr double kLongest_s = 0.1;
  const double end_s = path.end_s();
  const double length_s = std::min(kLongest_s, end_s - path.start_s());
  const Rigid3 end_from_world = path.poses().back().world_from_camera.inverse();
  // The way before the end is a velocity and half an acceleration: d = v t + a t^2 / 2.
  double tt = 0, ttt = 0, tttt = 0;
  Twist td = Twist::Zero(), ttd = Twist::Zero();
  for (const StampedPose& pose : path.poses()) {
    const double t = (pose.t_s - end_s) / length_s;
    if (t < -1) continue;
    const Twist d = (end_from_world * pose.world_from_camera).log();
    tt += t * t;
    ttt += t * t * t / 2;
    tttt += t * t * t * t / 4;
    td += t * d;
    ttd += t * t / 2 * d;
  }
  const double determinant = tt * tttt - ttt * ttt;
  constexpr double kLeast = 1e-9;  // of two poses, which tell a velocity alone
  if (!(determinant > kLeast)) return {};
  return {(tt * ttd - ttt * td) / (determinant * length_s * length_s), end_s + length_s};
}

/// `path` extrapolated at the velocity of its last 20 ms, or of all of it where it is shorter, and
/// at this acceleration as long as that lasts, until `until_s` or just beyond; `gyroscope`, where it
/// is not empty, measures the rotation.
[[nodiscard]] inline Trajectory extrapolated(const Trajectory& path, double until_s,
                                             const Gyroscope& gyroscope,
                                             const PathAcceleration& acceleration = {}) {
  constexpr double kLast_s = 0.02;
  const double end_s = path.end_s();
  const double last_s = std::min(kLast_s, end_s - path.start_s());
  const Rigid3 last = path.poses().back().world_from_camera;
  const double lasts_s = std::max(0.0, acceleration.until_s - end_s);
  // The velocity at their end is more than their mean by what is gained in them, as far as they are
  // accelerated: from the beginning until `until_s`.
  const double gaining_s = std::clamp(acceleration.until_s - (end_s - last_s), 0.0, last_s);
  const Twist velocity = (path.at_clamped(end_s - last_s).inverse() * last).log() / last_s +
                         0.5 * gaining_s * gaining_s / last_s * acceleration.rate;
  std::vector<StampedPose> poses(path.poses().begin(), path.poses().end());
  for (double t_s = end_s + kPoseSpacing_s; t_s < until_s + kPoseSpacing_s; t_s += kPoseSpacing_s) {
    const double way_s = t_s - end_s;
    const double faster_s = std::min(way_s, lasts_s);
    const Twist way = way_s * velocity + faster_s * (way_s - 0.5 * faster_s) * acceleration.rate;
    poses.push_back({t_s, last * Rigid3::exp(way)});
  }
  rotate_by(gyroscope, poses, path.size());
  return Trajectory(std::move(poses));
}

}  // namespace saccade
