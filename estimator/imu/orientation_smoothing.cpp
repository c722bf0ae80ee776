#include "estimator/imu/orientation_smoothing.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/rigid3.h"

namespace saccade {

Trajectory smoothed_orientations(const Trajectory& world_from_camera,
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

Eigen::Quaterniond without_roll(const Eigen::Quaterniond& world_from_camera) {
  const double full_correction = std::sin(10 * std::numbers::pi / 180);
  // The image of the world's down direction is to point along y.
  const Eigen::Vector3d down = world_from_camera.conjugate() * -Eigen::Vector3d::UnitZ();
  const double horizontal = std::hypot(down.x(), down.y());
  if (horizontal < 1e-12) return world_from_camera;
  const double roll = std::atan2(-down.x(), down.y()) * std::min(1.0, horizontal / full_correction);
  return world_from_camera * so3_exp({0, 0, roll});
}

}  // namespace saccade
