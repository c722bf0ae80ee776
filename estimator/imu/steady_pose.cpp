#include "estimator/imu/steady_pose.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/rigid3.h"

namespace saccade {

Trajectory steady_poses(const Trajectory& world_from_camera, const SteadyPoseOptions& options) {
  const double max_angle = options.max_angle_deg * std::numbers::pi / 180;
  std::vector<StampedPose> steady;
  steady.reserve(world_from_camera.size());
  Eigen::Quaterniond q;
  for (const StampedPose& pose : world_from_camera.poses()) {
    const Eigen::Quaterniond& now = pose.world_from_camera.rotation();
    if (steady.empty()) {
      q = now;
    } else {
      const double dt_s = pose.t_s - steady.back().t_s;
      q = q.slerp(1 - std::exp(-dt_s / options.time_constant_s), now);
      const double angle = angle_between(q, now);
      if (angle > max_angle) q = now.slerp(max_angle / angle, q);
    }
    steady.push_back({pose.t_s, {options.lock_roll ? without_roll(q) : q, {0, 0, 0}}});
  }
  return Trajectory(std::move(steady));
}

Eigen::Quaterniond without_roll(const Eigen::Quaterniond& world_from_camera) {
  const double full = std::sin(10 * std::numbers::pi / 180);
  // Down, as the camera sees it; across the viewing direction it shall point along y.
  const Eigen::Vector3d down = world_from_camera.conjugate() * -Eigen::Vector3d::UnitZ();
  const double level = std::hypot(down.x(), down.y());
  if (level < 1e-12) return world_from_camera;
  const double roll = std::atan2(-down.x(), down.y()) * std::min(1.0, level / full);
  return world_from_camera * so3_exp({0, 0, roll});
}

}  // namespace saccade
