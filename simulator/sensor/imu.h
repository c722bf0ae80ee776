#pragma once

#include <vector>

#include "core/config/fields.h"
#include "core/imu_sample.h"
#include "core/spline.h"

namespace saccade {

/// Gravity where z is up [m/s^2]; key `gravity_m_s2` of a simulation.
inline const Eigen::Vector3d kStandardGravity(0, 0, -9.81);

/// The inertial sensor (section `imu`).
struct ImuOptions {
  double rate_hz = 1000;     ///< 0: none
  Rigid3 camera_from_imu{};  ///< key T_camera_imu, 4 x 4
};

void describe(config::Fields& fields, ImuOptions& options);

/// What a perfect IMU on the moving camera reads at `t_s` (contract: the spline is
/// world_from_camera):
///   specific force = R_imu_world (a + alpha x r + w x (w x r) - g),   angular velocity =
///   R_imu_camera w
/// with the lever arm r from the camera to the IMU.
[[nodiscard]] ImuSample imu_sample(const Spline& motion, const Rigid3& camera_from_imu,
                                   const Eigen::Vector3d& gravity_m_s2, TimeNs t_ns);

/// Samples k / rate_hz from time 0 to the end of the motion; empty at rate 0.
[[nodiscard]] std::vector<ImuSample> imu_samples(const Spline& motion, const ImuOptions& options,
                                                 const Eigen::Vector3d& gravity_m_s2);

}  // namespace saccade
