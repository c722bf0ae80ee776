#include "estimator/imu/tilt.h"

#include <cmath>

namespace saccade {

Eigen::Quaterniond tilt_correction(const Eigen::Vector3d& g) {
  // Where gravity is predicted upside down, every horizontal axis is as good.
  constexpr double kUpsideDown = 1e-9;
  const double rise = g.z() + 1;
  if (rise < kUpsideDown) return {0, 1, 0, 0};
  const double scale = 1 / std::sqrt(2 * rise);
  return Eigen::Quaterniond(std::sqrt(rise / 2), -g.y() * scale, g.x() * scale, 0).normalized();
}

Eigen::Quaterniond tilt_of(const Eigen::Vector3d& specific_force) {
  if (!(specific_force.norm() > 0)) return Eigen::Quaterniond::Identity();
  const Eigen::Vector3d up = specific_force.normalized();
  constexpr double kUpright = 0.9;
  const Eigen::Vector3d ahead =
      std::abs(up.x()) < kUpright ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitY();
  const Eigen::Vector3d y = up.cross(ahead).normalized();
  Eigen::Matrix3d imu_from_world;
  imu_from_world << y.cross(up), y, up;
  return Eigen::Quaterniond(imu_from_world).conjugate();
}

Eigen::Quaterniond with_tilt_of(const Eigen::Quaterniond& world_from_imu,
                                const Eigen::Vector3d& specific_force) {
  if (!(specific_force.norm() > 0)) return world_from_imu;
  const Eigen::Vector3d up = world_from_imu * specific_force.normalized();
  return (tilt_correction(up).conjugate() * world_from_imu).normalized();
}

}  // namespace saccade
