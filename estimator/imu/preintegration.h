#pragma once

#include <optional>
#include <span>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/imu_sample.h"

namespace saccade {

/// Biases of gyroscope and accelerometer.
struct ImuBias {
  Eigen::Vector3d gyro = Eigen::Vector3d::Zero();   ///< [rad/s]
  Eigen::Vector3d accel = Eigen::Vector3d::Zero();  ///< [m/s^2]
};

/// The samples between two times i and j, integrated independently of pose and velocity at i
/// (Forster, Carlone, Dellaert and Scaramuzza, "On-Manifold Preintegration for Real-Time
/// Visual-Inertial Odometry", TRO 33(1), 2017; here by the midpoint rule). With angular velocity w
/// and specific force f less their biases,
///   dR' = dR Exp(w dt),   dV = sum dR f dt,   dP = sum dV dt + dR f dt^2 / 2,
/// orientation R, velocity v and position p of the sensor after T seconds are, g being gravity,
///   R_j = R_i dR,   v_j = v_i + g T + R_i dV,   p_j = p_i + v_i T + g T^2 / 2 + R_i dP.
struct Preintegration {
  using Matrix9 = Eigen::Matrix<double, 9, 9>;

  double duration_s = 0;                                         ///< T
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();  ///< dR
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();            ///< dV [m/s]
  Eigen::Vector3d position = Eigen::Vector3d::Zero();            ///< dP [m]
  ImuBias bias;                                                  ///< that was subtracted
  /// d(dR, dV, dP) / d(gyro bias, accel bias), the rotation as dR Exp(rows 0-2).
  Eigen::Matrix<double, 9, 6> bias_jacobian = Eigen::Matrix<double, 9, 6>::Zero();
  Matrix9 covariance = Matrix9::Zero();  ///< of (dR, dV, dP), from white noise
  /// Angular velocity at both ends, less the bias [rad/s].
  Eigen::Vector3d first_rate = Eigen::Vector3d::Zero(), last_rate = Eigen::Vector3d::Zero();

  /// dR, dV and dP for other biases, to first order.
  [[nodiscard]] Eigen::Quaterniond rotation_with(const ImuBias& other) const;
  [[nodiscard]] Eigen::Vector3d velocity_with(const ImuBias& other) const;
  [[nodiscard]] Eigen::Vector3d position_with(const ImuBias& other) const;
};

/// Integrates from from_s to to_s > from_s; samples are interpolated linearly at both. `samples`:
/// in order of time; of `noise` only the densities are used. nullopt where the samples do not span
/// the interval, or leave a gap of more than 0.1 s.
[[nodiscard]] std::optional<Preintegration> preintegrate(std::span<const ImuSample> samples,
                                                         double from_s, double to_s,
                                                         const ImuBias& bias,
                                                         const ImuCalibration& noise);

}  // namespace saccade
