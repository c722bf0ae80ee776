#pragma once

#include <optional>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/event.h"
#include "core/imu_sample.h"
#include "estimator/imu/steady_bias.h"

namespace saccade {

/// What is known of an accelerometer.
struct AccelerometerNoise {
  double density = 1e-2;      ///< of its white noise [m/s^2/sqrt(Hz)]
  double random_walk = 2e-4;  ///< of its bias [m/s^3/sqrt(Hz)]
  double bias_sigma = 0.05;   ///< deviation of its bias at the start [m/s^2]
};

struct InertialOptions {
  double gravity = 9.81;    ///< [m/s^2]
  double speed = 1;         ///< deviation of a component of the velocity [m/s],
  double speed_time_s = 1;  ///< which is another one after this time
  /// Deviation of a component of the position [m], another one after this time; nullopt: it may go
  /// anywhere.
  std::optional<double> reach = 0.5;
  double reach_time_s = 0.5;
  double tilt_sigma = 0.1;       ///< deviation of the tilt read from one specific force [rad]
  double max_gap_s = 0.1;        ///< after a longer one the tilt is read again
  int readings_per_update = 10;  ///< the covariance follows the state in steps of so many
  RestOptions rest;
  GyroscopeNoise gyroscope;
  AccelerometerNoise accelerometer;
};

/// Orientation, velocity, position and both biases by an error-state Kalman filter. What tells
/// gravity from acceleration is that a thing in a hand stays slow and within reach, however hard it
/// is shaken:
///   R' = R exp((w - b) dt),  v' = v + (R (f - c) - g) dt,  p' = p + v dt,   R = world_from_imu
///   errors  theta' = theta - R db dt,  dv' = dv - [R (f - c)]x theta dt - R dc dt,
///           dp' = dp + dv dt,  R_true = exp(theta) R
///   measured  v = 0 +- speed, once in speed_time_s,  p = 0 +- reach, once in reach_time_s;
///             at rest v = 0 and b = w
/// A tilt that is wrong by an angle a moves the position by g a t^2 / 2, the velocity by g a t:
/// over many seconds the position says more, but of things that stay where they are. The specific
/// force enters as a vector: normalised, as the complementary filter has it, its direction under
/// strong accelerations is no longer that of gravity on the average. The world's z axis points up,
/// heading as in ComplementaryFilter.
class InertialFilter {
 public:
  explicit InertialFilter(const InertialOptions& options);

  /// Takes a reading in; times increase (contract).
  void update(const ImuSample& sample);

  [[nodiscard]] const Eigen::Quaterniond& world_from_imu() const { return world_from_imu_; }
  [[nodiscard]] const Eigen::Vector3d& bias() const { return bias_; }  ///< [rad/s]
  [[nodiscard]] double bias_sigma() const;  ///< of one component, RMS [rad/s]
  [[nodiscard]] double tilt_sigma() const;  ///< of one component, RMS [rad]
  [[nodiscard]] bool is_at_rest() const { return rest_.is_at_rest(); }
  [[nodiscard]] int gaps() const { return gaps_; }

 private:
  using Covariance = Eigen::Matrix<double, 15, 15>;

  void start(const ImuSample& sample);
  void propagate(const ImuSample& sample, double dt_s);
  void propagate_covariance();
  /// Of three components of the state from `first` on, whose errors are independent.
  void measure(int first, const Eigen::Vector3d& innovation, double variance);

  InertialOptions options_;
  RestDetector rest_;
  Eigen::Quaterniond world_from_imu_ = Eigen::Quaterniond::Identity();
  Eigen::Vector3d bias_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d force_bias_ = Eigen::Vector3d::Zero();  ///< c [m/s^2]
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();    ///< in the world [m/s]
  Eigen::Vector3d position_ = Eigen::Vector3d::Zero();    ///< in the world [m]
  Covariance covariance_ = Covariance::Zero();            ///< of theta, b, v, c, p
  ImuSample last_;
  bool has_last_ = false;
  int readings_ = 0;                                     ///< since the last update
  double interval_s_ = 0;                                ///< covered by them
  Eigen::Vector3d force_sum_ = Eigen::Vector3d::Zero();  ///< integral of R (f - c) [m/s]
  int gaps_ = 0;
};

}  // namespace saccade
