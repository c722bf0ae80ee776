#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "core/rigid3.h"
#include "core/trajectory.h"

namespace saccade {

struct SmoothingOptions {
  enum class LowPass {
    kCentred,  ///< forwards and then backwards in time, which does not lag
    kCausal,   ///< forwards, as in the thesis
  };
  LowPass low_pass = LowPass::kCentred;
  double time_constant_s = 0.4;  ///< tau: alpha of (3.18) is 1 - exp(-dt / tau), 0.1 at 24 Hz
  bool lock_roll = false;
  double max_angle_deg = 20;
};

/// The same viewing direction with the camera's x axis (the rows of the image) horizontal and y
/// pointing down. Within 10 degrees of the vertical the correction fades to none.
[[nodiscard]] inline Eigen::Quaterniond without_roll(const Eigen::Quaterniond& world_from_camera) {
  const double full_correction = std::sin(10 * std::numbers::pi / 180);
  // The image of the world's down direction is to point along y.
  const Eigen::Vector3d down = world_from_camera.conjugate() * -Eigen::Vector3d::UnitZ();
  const double horizontal = std::hypot(down.x(), down.y());
  if (horizontal < 1e-12) return world_from_camera;
  const double roll = std::atan2(-down.x(), down.y()) * std::min(1.0, horizontal / full_correction);
  return world_from_camera * so3_exp({0, 0, roll});
}

/// What orientations would be before the first and after the last, for `reach_s` at most: what is
/// known turned about its ends, q(T + s) = q(T) q(T - s)^-1 q(T), so that a turn goes on as it is.
/// The known ones stand in the midst.
struct ExtendedOrientations {
  std::vector<StampedPose> poses;
  std::size_t before = 0;  ///< added before the first
};
[[nodiscard]] inline ExtendedOrientations extended(std::span<const StampedPose> poses,
                                                   double reach_s) {
  const auto about = [](const StampedPose& end, const StampedPose& pose) {
    const Eigen::Quaterniond& q_end = end.world_from_camera.rotation();
    const Eigen::Quaterniond q = q_end * pose.world_from_camera.rotation().conjugate() * q_end;
    return StampedPose{2 * end.t_s - pose.t_s, {q.normalized(), {0, 0, 0}}};
  };
  ExtendedOrientations all;
  for (std::size_t k = poses.size(); k-- > 1;)
    if (poses[k].t_s - poses.front().t_s <= reach_s)
      all.poses.push_back(about(poses.front(), poses[k]));
  all.before = all.poses.size();
  all.poses.insert(all.poses.end(), poses.begin(), poses.end());
  for (std::size_t k = poses.size() - 1; k-- > 0;) {
    if (poses.back().t_s - poses[k].t_s > reach_s) break;
    all.poses.push_back(about(poses.back(), poses[k]));
  }
  return all;
}

/// The steady orientation that pictures are rotated to (thesis 3.2): that of the camera after a
/// low-pass filter,
///   q_s <- Slerp(q_s, q_k, alpha) = (q_k q_s^-1)^alpha q_s                                 (3.18)
/// once for every pose, in order of time, from the first one on. (The thesis prints
/// (q_s q_k^-1)^alpha q_s, which moves away from q_k.) A centred one goes on beyond both ends as
/// extended() has it and filters the result again, from the last pose back: at a constant rate it is
/// where the camera is, in place of tau behind, and the view keeps what the camera sees. The result
/// has the same times and zero positions.
[[nodiscard]] inline Trajectory smoothed_orientations(const Trajectory& world_from_camera,
                                                      const SmoothingOptions& options) {
  const auto poses = world_from_camera.poses();
  if (poses.empty()) return {};
  const double max_angle = options.max_angle_deg * std::numbers::pi / 180;
  const bool is_centred = options.low_pass == SmoothingOptions::LowPass::kCentred;
  // After so many time constants 2 % of a lag is left.
  constexpr double kReach = 4;
  const ExtendedOrientations all =
      extended(poses, is_centred ? kReach * options.time_constant_s : 0);
  const auto alpha = [&](std::size_t a, std::size_t b) {
    return 1 - std::exp(-(all.poses[b].t_s - all.poses[a].t_s) / options.time_constant_s);
  };
  const auto within_reach = [&](const Eigen::Quaterniond& steady, std::size_t k) {
    const Eigen::Quaterniond& q_k = all.poses[k].world_from_camera.rotation();
    const double angle = angle_between(steady, q_k);
    return angle > max_angle ? q_k.slerp(max_angle / angle, steady) : steady;
  };
  std::vector<Eigen::Quaterniond> steady;
  steady.reserve(all.poses.size());
  for (std::size_t k = 0; k < all.poses.size(); ++k) {
    const Eigen::Quaterniond& q_k = all.poses[k].world_from_camera.rotation();
    steady.push_back(k == 0 ? q_k : steady.back().slerp(alpha(k - 1, k), q_k));  // (3.18)
    if (!is_centred) steady.back() = within_reach(steady.back(), k);
  }
  if (is_centred)
    for (std::size_t k = all.poses.size(); k-- > 1;)
      steady[k - 1] = steady[k].slerp(alpha(k - 1, k), steady[k - 1]);
  std::vector<StampedPose> smoothed;
  smoothed.reserve(poses.size());
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const Eigen::Quaterniond q_s = within_reach(steady[all.before + k], all.before + k);
    smoothed.push_back({poses[k].t_s, {options.lock_roll ? without_roll(q_s) : q_s, {0, 0, 0}}});
  }
  return Trajectory(std::move(smoothed));
}

}  // namespace saccade
