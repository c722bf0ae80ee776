#include "estimator/imu/tilt.h"

#include <cmath>

namespace saccade {

Eigen::Quaterniond tilt_correction(const Eigen::Vector3d& g) {
  // (3.12) is singular at g_z = -1, where any horizontal axis will do.
  constexpr double kSingular = 1e-9;
  const double gz_plus_1 = g.z() + 1;
  if (gz_plus_1 < kSingular) return {0, 1, 0, 0};
  const double scale = 1 / std::sqrt(2 * gz_plus_1);
  return Eigen::Quaterniond(std::sqrt(gz_plus_1 / 2), -g.y() * scale, g.x() * scale, 0)  // (3.12)
      .normalized();
}

Eigen::Quaterniond tilt_from_specific_force(const Eigen::Vector3d& specific_force) {
  if (!(specific_force.norm() > 0)) return Eigen::Quaterniond::Identity();
  const Eigen::Vector3d up = specific_force.normalized();
  constexpr double kVertical = 0.9;
  const Eigen::Vector3d forward =
      std::abs(up.x()) < kVertical ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitY();
  const Eigen::Vector3d y = up.cross(forward).normalized();
  Eigen::Matrix3d imu_from_world;
  imu_from_world << y.cross(up), y, up;
  return Eigen::Quaterniond(imu_from_world).conjugate();
}

Eigen::Quaterniond corrected_tilt(const Eigen::Quaterniond& world_from_imu,
                                  const Eigen::Vector3d& specific_force) {
  if (!(specific_force.norm() > 0)) return world_from_imu;
  const Eigen::Vector3d up = world_from_imu * specific_force.normalized();
  return (tilt_correction(up).conjugate() * world_from_imu).normalized();
}

}  // namespace saccade
