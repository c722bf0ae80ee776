#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include <Eigen/QR>

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

/// How the velocity changes at the end of given poses, and until when it may be taken to go on so.
struct PathAcceleration {
  Twist rate = Twist::Zero();  ///< at their end, of the twist in the camera [m/s^2, rad/s^2]
  Twist jerk = Twist::Zero();  ///< by which it changes [m/s^3, rad/s^3]
  double end_s = 0;            ///< of the poses
  double until_s = 0;

  [[nodiscard]] Twist at(double t_s) const { return rate + (t_s - end_s) * jerk; }
};

/// The acceleration at the end of the last tenth of a second of `path`, or of all of it where it is
/// shorter, by least squares, and its change where that stands out from the noise of the poses: a
/// camera that leaves its rest goes a third of its way by it. Both last for as long again.
[[nodiscard]] inline PathAcceleration last_acceleration(const Trajectory& path) {
  constexpr double kLongest_s = 0.1;
  const double end_s = path.end_s();
  const double length_s = std::min(kLongest_s, end_s - path.start_s());
  const Rigid3 end_from_world = path.poses().back().world_from_camera.inverse();
  std::vector<double> times;  // before the end, of the length
  std::vector<Twist> twists;
  for (const StampedPose& pose : path.poses()) {
    const double t = (pose.t_s - end_s) / length_s;
    if (t < -1) continue;
    times.push_back(t);
    twists.push_back((end_from_world * pose.world_from_camera).log());
  }
  // The way is a velocity, half an acceleration and a sixth of its change:
  // d = v t + a t^2 / 2 + j t^3 / 6.
  const auto count = static_cast<Eigen::Index>(times.size());
  Eigen::MatrixX4d powers(count, 4);
  Eigen::Matrix<double, Eigen::Dynamic, 6> ways(count, 6);
  for (Eigen::Index i = 0; i < count; ++i) {
    const double t = times[static_cast<std::size_t>(i)];
    powers.row(i) << t, t * t / 2, t * t * t / 6, 1;
    ways.row(i) = twists[static_cast<std::size_t>(i)].transpose();
  }
  constexpr Eigen::Index kLeast = 3, kLeastOfChange = 10;  // poses; fewer hardly tell their noise
  if (count < kLeast) return {};
  const auto squares = powers.leftCols<2>();
  const Eigen::MatrixXd quadratic = squares.colPivHouseholderQr().solve(ways);
  PathAcceleration acceleration;
  acceleration.rate = quadratic.row(1).transpose() / (length_s * length_s);
  acceleration.end_s = end_s;
  acceleration.until_s = end_s + length_s;
  if (count < kLeastOfChange) return acceleration;
  // The noise of the last pose is in all ways, as the fourth unknown.
  const Eigen::MatrixXd cubic = powers.colPivHouseholderQr().solve(ways);
  const Eigen::MatrixX3d without_cubes = powers(Eigen::all, {0, 1, 3});
  const Eigen::MatrixXd less = without_cubes.colPivHouseholderQr().solve(ways);
  // Four sigmas, as squares beside the variance that is left.
  constexpr double kStandsOut = 16;
  for (Eigen::Index k = 0; k < 6; ++k) {
    const double without = (ways.col(k) - without_cubes * less.col(k)).squaredNorm();
    const double with = (ways.col(k) - powers * cubic.col(k)).squaredNorm();
    if (!(without - with > kStandsOut * with / static_cast<double>(count - 4))) continue;
    acceleration.rate[k] = cubic(1, k) / (length_s * length_s);
    acceleration.jerk[k] = cubic(2, k) / (length_s * length_s * length_s);
  }
  return acceleration;
}

/// `path` extrapolated at the velocity of its last 20 ms, or of all of it where it is shorter, and
/// at this acceleration, which changes on, as long as that lasts, until `until_s` or just beyond;
/// `gyroscope`, where it is not empty, measures the rotation.
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
  const Twist gained = acceleration.at(end_s - last_s + gaining_s);
  const Twist velocity =
      ((path.at_clamped(end_s - last_s).inverse() * last).log() +
       gaining_s * gaining_s * (gained / 2 - gaining_s / 6 * acceleration.jerk)) /
      last_s;
  const Twist now = acceleration.at(end_s);
  std::vector<StampedPose> poses(path.poses().begin(), path.poses().end());
  for (double t_s = end_s + kPoseSpacing_s; t_s < until_s + kPoseSpacing_s; t_s += kPoseSpacing_s) {
    const double way_s = t_s - end_s;
    const double faster_s = std::min(way_s, lasts_s);
    const Twist gain = faster_s * (now + faster_s / 2 * acceleration.jerk);
    const Twist way = way_s * velocity +
                      faster_s * faster_s * (now / 2 + faster_s / 6 * acceleration.jerk) +
                      (way_s - faster_s) * gain;
    poses.push_back({t_s, last * Rigid3::exp(way)});
  }
  rotate_by(gyroscope, poses, path.size());
  return Trajectory(std::move(poses));
}

}  // namespace saccade
