#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "core/rigid3.h"
#include "core/trajectory.h"

namespace saccade {

struct SmoothingOptions {
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

/// The steady orientation that pictures are rotated to (thesis 3.2): that of the camera after a
/// low-pass filter,
///   q_s <- Slerp(q_s, q_k, alpha) = (q_k q_s^-1)^alpha q_s                                 (3.18)
/// once for every pose, in order of time. (The thesis prints (q_s q_k^-1)^alpha q_s, which moves
/// away from q_k.) Starts at the first pose. The result has the same times and zero positions.
[[nodiscard]] inline Trajectory smoothed_orientations(const Trajectory& world_from_camera,
                                                      const SmoothingOptions& options) {
  const double max_angle = options.max_angle_deg * std::numbers::pi / 180;
  std::vector<StampedPose> smoothed;
  smoothed.reserve(world_from_camera.size());
  Eigen::Quaterniond q_s;
  for (const StampedPose& pose : world_from_camera.poses()) {
    const Eigen::Quaterniond& q_k = pose.world_from_camera.rotation();
    if (smoothed.empty()) {
      q_s = q_k;
    } else {
      const double dt_s = pose.t_s - smoothed.back().t_s;
      q_s = q_s.slerp(1 - std::exp(-dt_s / options.time_constant_s), q_k);  // (3.18)
      const double angle = angle_between(q_s, q_k);
      if (angle > max_angle) q_s = q_k.slerp(max_angle / angle, q_s);
    }
    smoothed.push_back({pose.t_s, {options.lock_roll ? without_roll(q_s) : q_s, {0, 0, 0}}});
  }
  return Trajectory(std::move(smoothed));
}

}  // namespace saccade
