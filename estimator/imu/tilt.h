#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace saccade {

/// dq of (3.12): the shortest rotation of the z axis to a unit vector; half a revolution about x
/// where that vector points down.
[[nodiscard]] Eigen::Quaterniond tilt_correction(const Eigen::Vector3d& predicted_gravity);

/// world_from_imu at rest, from the specific force alone. The world's z axis points up; its x axis
/// has the heading of the sensor's x axis (its y axis that of the sensor's y axis, where x is
/// vertical). Identity where the force is zero.
[[nodiscard]] Eigen::Quaterniond tilt_from_specific_force(const Eigen::Vector3d& specific_force);

/// The orientation after the shortest rotation that makes the specific force point up; unchanged
/// where the force is zero.
[[nodiscard]] Eigen::Quaterniond corrected_tilt(const Eigen::Quaterniond& world_from_imu,
                                                const Eigen::Vector3d& specific_force);

}  // namespace saccade
