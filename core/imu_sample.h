#pragma once

#include <Eigen/Core>

#include "core/event.h"

namespace saccade {

/// One reading of an inertial sensor, in its own frame.
struct ImuSample {
  TimeNs t_ns = 0;
  Eigen::Vector3d specific_force = Eigen::Vector3d::Zero();    ///< [m/s^2]; +9.81 upwards at rest
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();  ///< [rad/s]
  bool may_rest = true;  ///< false where something else shows that the sensor turns
};

/// What is behind a reading: reading = ideal + bias + white noise.
struct ImuTruth {
  ImuSample ideal;                                       ///< of a perfect sensor
  Eigen::Vector3d accel_bias = Eigen::Vector3d::Zero();  ///< [m/s^2]
  Eigen::Vector3d gyro_bias = Eigen::Vector3d::Zero();   ///< [rad/s]
};

/// What an orientation filter believes of a gyroscope at one reading.
struct GyroBiasEstimate {
  TimeNs t_ns = 0;
  Eigen::Vector3d bias = Eigen::Vector3d::Zero();  ///< in the sensor's frame [rad/s]
  double sigma = 0;                                ///< of one component [rad/s]
  bool at_rest = false;                            ///< the sensor did not move lately
};

/// Continuous-time noise of one triad of an inertial sensor, as Kalibr states it. In SI units
/// (U = rad/s or m/s^2).
struct TriadNoise {
  double density = 0;      ///< of the white noise [U/sqrt(Hz)]
  double random_walk = 0;  ///< of the bias [U/s/sqrt(Hz)]
};

/// What an estimator must know of an inertial sensor (imu.yaml).
struct ImuCalibration {
  double rate_hz = 0;
  TriadNoise accelerometer;
  TriadNoise gyroscope;
};

}  // namespace saccade
