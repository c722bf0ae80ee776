#include "simulator/sensor/motion/image_motion.h"

#include <algorithm>
#include <limits>

namespace saccade {
Twist camera_twist(const SplineState& state) {
  Twist twist;
  twist << state.world_from_body.rotation().conjugate() * state.velocity_in_world,
      state.angular_velocity_in_body;
  return twist;
}

Eigen::Matrix2d distortion_jacobian(const PinholeCamera& camera, const Eigen::Vector2d& pixel) {
  if (!camera.is_distorted()) return Eigen::Matrix2d::Identity();
  constexpr double kStep_px = 1e-3;
  Eigen::Matrix2d jacobian;
  for (int k = 0; k < 2; ++k) {
    const Eigen::Vector2d step = kStep_px * Eigen::Vector2d::Unit(k);
    jacobian.col(k) =
        (camera.distort(pixel + step) - camera.distort(pixel - step)) / (2 * kStep_px);
  }
  return jacobian;
}

Eigen::Vector2d point_motion(const PinholeCamera& camera, const Eigen::Vector3d& ray, double depth,
                             const Twist& twist) {
  const double z = depth > 0 ? depth : std::numeric_limits<double>::infinity();
  // In the camera's frame the point moves by minus the camera's twist.
  const Eigen::Vector2d ideal = -interaction_matrix(camera, ray, z) * twist;
  return distortion_jacobian(camera, camera.project(ray)) * ideal;
}

Twist relative_twist(const SplineState& camera, const SplineState& object) {
  const Eigen::Quaterniond camera_from_world = camera.world_from_body.rotation().conjugate();
  const Eigen::Vector3d turning =
      object.world_from_body.rotation() * object.angular_velocity_in_body;
  const Eigen::Vector3d apart =
      camera.world_from_body.translation() - object.world_from_body.translation();
  Twist moved;
  moved << camera_from_world * (object.velocity_in_world + turning.cross(apart)),
      camera_from_world * turning;
  return camera_twist(camera) - moved;
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
