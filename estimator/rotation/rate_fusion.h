#pragma once

#include <optional>

#include <Eigen/Core>

#include "estimator/imu/gyro_bias_estimator.h"

namespace saccade {

/// Angular velocity of one window by both sensors, in camera axes.
struct RateMeasurements {
  double t_s = 0;          ///< middle of the window
  double averaged_s = 0;   ///< effective averaging time of the gyroscope, > 0
  double px_per_rate = 0;  ///< RMS displacement of the window's events at 1 rad/s [px], > 0
  Eigen::Vector3d gyroscope = Eigen::Vector3d::Zero();  ///< in the middle [rad/s]
  Eigen::Vector3d events = Eigen::Vector3d::Zero();     ///< [rad/s]
};

/// Angular velocity w and bias b of the gyroscope from gyroscope and events:
///   gyroscope = w + b + N(0, density^2 / averaged_s),  b a random walk,
///   events    = w + N(0, (s / px_per_rate)^2),
/// without a prior of w. Their difference measures the bias (Kalman filter per axis), and w is the
/// mean of events and gyroscope - b weighted by their variances. s, the sigma of the events in
/// pixels, is adapted per axis to the part of the differences that the gyroscope does not explain.
/// A difference beyond five sigma is an outlier: the window then takes the gyroscope alone.
class RateFusion {
 public:
  explicit RateFusion(const GyroscopeNoise& gyroscope = {});

  /// The angular velocity of a window [rad/s]; windows come in order of time.
  Eigen::Vector3d fuse(const RateMeasurements& measured);
  /// The same for a window without an estimate from events.
  [[nodiscard]] Eigen::Vector3d without_events(const Eigen::Vector3d& gyroscope) const {
    return gyroscope - bias_;
  }

  [[nodiscard]] const Eigen::Vector3d& bias() const { return bias_; }  ///< camera axes [rad/s]
  [[nodiscard]] Eigen::Vector3d bias_sigma() const;                    ///< [rad/s]
  [[nodiscard]] Eigen::Vector3d events_sigma_px() const;               ///< s

 private:
  GyroscopeNoise noise_;
  std::optional<double> last_s_;
  Eigen::Vector3d bias_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d bias_variance_;
  Eigen::Vector3d events_variance_;  ///< s^2 [px^2]
  int windows_ = 0;                  ///< that s was adapted to
};

}  // namespace saccade
