#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace saccade {

/// dq of (3.12): takes the z axis to a direction of length 1, the shortest way; by half a turn
/// about x where that points down.
[[nodiscard]] Eigen::Quaterniond tilt_correction(const Eigen::Vector3d& predicted_gravity);

/// world_from_imu at rest, from the specific force alone. The world's z axis points up; its x axis
/// has the heading of the sensor's (or its y axis that of the sensor's, where x stands upright).
/// Identity where the force is zero.
[[nodiscard]] Eigen::Quaterniond tilt_of(const Eigen::Vector3d& specific_force);

/// The orientation turned, the shortest way, so that the specific force points up; unchanged where
/// the force is zero.
[[nodiscard]] Eigen::Quaterniond with_tilt_of(const Eigen::Quaterniond& world_from_imu,
                                              const Eigen::Vector3d& specific_force);

}  // namespace saccade
