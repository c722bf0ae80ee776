#pragma once

#include <cstdint>
#include <vector>

#include "core/config/fields.h"
#include "core/imu_sample.h"
#include "core/spline/spline.h"

namespace saccade {

/// Gravity where z is up [m/s^2]; key `gravity_m_s2` of a simulation.
inline const Eigen::Vector3d kStandardGravity(0, 0, -9.81);

/// The inertial sensor (section `imu`); without noise unless asked for (imu_noise.h has the model).
struct ImuOptions {
  double rate_hz = 1000;
  Rigid3 camera_from_imu{};  ///< key T_camera_imu, 4 x 4
  TriadNoise gyroscope{};
  TriadNoise accelerometer{};
  Eigen::Vector3d gyro_bias = Eigen::Vector3d::Zero();   ///< [rad/s]
  Eigen::Vector3d accel_bias = Eigen::Vector3d::Zero();  ///< [m/s^2]

  [[nodiscard]] ImuCalibration calibration() const { return {rate_hz, accelerometer, gyroscope}; }
};

void describe(config::Fields& fields, ImuOptions& options);

/// What a perfect IMU on the moving camera reads at `t_ns` (contract: the spline is
/// world_from_camera):
///   specific force = R_imu_world (a - g),   angular velocity = w_imu
/// with the acceleration a of the IMU itself (Spline::attached gives its lever arm).
[[nodiscard]] ImuSample imu_sample(const Spline& motion, const Rigid3& camera_from_imu,
                                   const Eigen::Vector3d& gravity_m_s2, TimeNs t_ns);

/// A recording and what is behind it, reading by reading.
struct ImuRecording {
  std::vector<ImuSample> readings;
  std::vector<ImuTruth> truth;
};

/// Readings k / rate_hz from time 0 to the end of the motion; empty at rate 0. `seed`: of the
/// noise.
[[nodiscard]] ImuRecording record_imu(const Spline& motion, const ImuOptions& options,
                                      const Eigen::Vector3d& gravity_m_s2, std::uint64_t seed);

}  // namespace saccade
