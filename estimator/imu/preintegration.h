#pragma once

#include <optional>
#include <span>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/imu_sample.h"

namespace saccade {

/// What an inertial sensor reads too much of.
struct ImuBias {
  Eigen::Vector3d gyro = Eigen::Vector3d::Zero();   ///< [rad/s]
  Eigen::Vector3d accel = Eigen::Vector3d::Zero();  ///< [m/s^2]
};

/// The readings between two instants summed up, whatever the pose and the velocity at the first
/// (Forster et al., "On-manifold preintegration", TRO 33(1), 2017; midpoint rule). With readings
/// w, f less their biases and Q from the first instant on,
///   Q' = Q Exp(w dt),   V = sum of Q f dt,   P = sum of V dt + Q f dt^2 / 2,
/// the sensor's orientation R, velocity v and position p after the time T are, g being gravity,
///   R' = R Q,   v' = v + g T + R V,   p' = p + v T + g T^2 / 2 + R P.
struct Preintegration {
  using Matrix9 = Eigen::Matrix<double, 9, 9>;

  double duration_s = 0;                                     ///< T
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();  ///< Q
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();        ///< V [m/s]
  Eigen::Vector3d position = Eigen::Vector3d::Zero();        ///< P [m]
  ImuBias bias;                                              ///< that was subtracted
  /// How they change with the biases (gyro, accel): Q Exp(rows 0-2), V, P.
  Eigen::Matrix<double, 9, 6> by_bias = Eigen::Matrix<double, 9, 6>::Zero();
  Matrix9 covariance = Matrix9::Zero();  ///< of (turn, V, P), from white noise
  /// Angular velocity at both ends, less the bias [rad/s].
  Eigen::Vector3d first_rate = Eigen::Vector3d::Zero(), last_rate = Eigen::Vector3d::Zero();

  /// Q, V and P for other biases, to first order.
  [[nodiscard]] Eigen::Quaterniond turn_with(const ImuBias& other) const;
  [[nodiscard]] Eigen::Vector3d velocity_with(const ImuBias& other) const;
  [[nodiscard]] Eigen::Vector3d position_with(const ImuBias& other) const;
};

/// Sums up the readings from from_s to to_s > from_s, interpolated at both. `readings`: in order of
/// time; only the noise densities of `noise` are used. nullopt where the readings do not reach
/// from one end to the other, or leave a gap of more than 0.1 s.
[[nodiscard]] std::optional<Preintegration> preintegrate(std::span<const ImuSample> readings,
                                                         double from_s, double to_s,
                                                         const ImuBias& bias,
                                                         const ImuCalibration& noise);

}  // namespace saccade
