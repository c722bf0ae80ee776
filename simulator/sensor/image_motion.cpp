#include "simulator/sensor/image_motion.h"

#include <algorithm>
#include <limits>

namespace saccade {

Twist camera_twist(const SplineState& state) {
  Twist twist;
  twist << state.world_from_body.rotation().conjugate() * state.velocity_in_world,
      state.angular_velocity_in_body;
  return twist;
}

ImageSpeed image_speed_bound(const PinholeCamera& camera, const Eigen::Vector3d& ray,
                             double radius_px, const Twist& twist, const InverseDepthRange& range) {
  const Eigen::Vector3d v = twist.head<3>();
  const Eigen::Vector3d w = twist.tail<3>();
  const double x = ray.x();
  const double y = ray.y();
  // The motion of a point is minus the camera's: u' = rotation + translation / z.
  const Eigen::Vector2d rotation(camera.fx * (x * y * w.x() - (1 + x * x) * w.y() + y * w.z()),
                                 camera.fy * ((1 + y * y) * w.x() - x * y * w.y() - x * w.z()));
  const Eigen::Vector2d translation(camera.fx * (x * v.z() - v.x()),
                                    camera.fy * (y * v.z() - v.y()));
  const double low = (rotation + range.low * translation).norm();
  const double high = (rotation + range.high * translation).norm();
  const double growth = w.norm() * (1 + 2 * ray.head<2>().norm()) + range.high * std::abs(v.z());
  const double parallax =
      (range.high - range.low) * (translation.norm() + radius_px * std::abs(v.z()));
  return {std::max(low, high) + radius_px * growth, parallax};
}

}  // namespace saccade
