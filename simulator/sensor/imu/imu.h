#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/config/fields.h"
#include "core/imu_sample.h"
#include "core/spline/spline.h"

namespace saccade {

enum class ImuTriad { kGyroscope, kAccelerometer };

/// What noise adds to one reading of a triad.
struct TriadError {
  Eigen::Vector3d bias = Eigen::Vector3d::Zero();
  Eigen::Vector3d white = Eigen::Vector3d::Zero();
};

/// The errors of `count` readings `dt_s` > 0 apart, independent on the three axes (Kalibr's model;
/// Trawny and Roumeliotis, "Indirect Kalman filter for 3D attitude estimation", 2005):
///   white_k ~ N(0, density^2 / dt)
///   bias_0 = turn_on_bias,   bias_k - bias_{k-1} ~ N(0, random_walk^2 dt)
/// Allan deviations are then density / sqrt(tau) and random_walk sqrt(tau / 3). Each draw belongs
/// to (seed, triad and axis, k), so that the readings of a shorter recording are the first ones of
/// a longer.
[[nodiscard]] std::vector<TriadError> triad_errors(const TriadNoise& noise,
                                                   const Eigen::Vector3d& turn_on_bias, double dt_s,
                                                   std::uint64_t seed, ImuTriad triad,
                                                   std::size_t count);

/// Gravity where z is up [m/s^2]; key `gravity_m_s2` of a simulation.
inline const Eigen::Vector3d kStandardGravity(0, 0, -9.81);

/// The inertial sensor (section `imu`); without noise unless asked for (triad_errors() has the
/// model).
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
