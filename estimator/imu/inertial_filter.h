#pragma once

#include <optional>
#include <utility>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/imu_sample.h"
#include "estimator/imu/gyro_bias_estimator.h"

namespace saccade {

struct InertialFilterOptions {
  double velocity_sigma = 1;                     ///< sigma_v [m/s]
  std::optional<double> position_sigma_m = 0.5;  ///< sigma_p; nullopt: the position is free
};

/// What an inertial filter knows.
struct InertialState {
  /// First rows of the errors: true R = exp(theta) R, of the others the differences.
  static constexpr int kTheta = 0, kBias = 3, kVelocity = 6, kAccelBias = 9, kPosition = 12;
  using Errors = Eigen::Matrix<double, 15, 1>;
  using Covariance = Eigen::Matrix<double, 15, 15>;

  Eigen::Quaterniond world_from_imu = Eigen::Quaterniond::Identity();  ///< R
  Eigen::Vector3d bias = Eigen::Vector3d::Zero();        ///< b, of the gyroscope [rad/s]
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();    ///< v, in the world [m/s]
  Eigen::Vector3d accel_bias = Eigen::Vector3d::Zero();  ///< c [m/s^2]
  Eigen::Vector3d position = Eigen::Vector3d::Zero();    ///< p, in the world [m]
  Covariance covariance = Covariance::Zero();
};

/// A reading of the motion that runs backwards in time, at minus its time: the rate turns round, the
/// specific force does not.
[[nodiscard]] inline ImuSample reversed(const ImuSample& sample) {
  return {-sample.t_ns, sample.specific_force, -sample.angular_velocity, sample.may_rest};
}
/// The state of the motion that runs backwards in time: velocity and gyroscope's bias turn round.
[[nodiscard]] InertialState reversed(const InertialState& state);

/// Orientation, velocity, position and both biases by an error-state Kalman filter. What separates
/// gravity from acceleration is that a hand-held device stays slow and within reach, however hard
/// it is shaken:
///   R' = R exp((w - b) dt),  v' = v + (R (f - c) - g) dt,  p' = p + v dt,   R = world_from_imu
///   errors  theta' = theta - R db dt,  dv' = dv - [R (f - c)]x theta dt - R dc dt,
///           dp' = dp + dv dt,  R_true = exp(theta) R
///   pseudo-measurements  v = 0 with sigma_v, one per second, and p = 0 with sigma_p, one per 0.5 s;
///           at rest v = 0 and b = w
/// A tilt error a moves the position by g a t^2 / 2 and the velocity by g a t: over many seconds the
/// position is the more informative, if the device stays where it is. The specific force enters as
/// a vector: its direction alone, as in the complementary filter, is biased under strong
/// accelerations. The world's z axis points up, heading as in ComplementaryFilter.
class InertialFilter {
 public:
  explicit InertialFilter(const InertialFilterOptions& options,
                          const GyroscopeNoise& gyroscope = {});

  /// Adds a sample; times increase (contract).
  void update(const ImuSample& sample);

  [[nodiscard]] const InertialState& state() const { return state_; }
  /// Brings the covariance to the time of the last sample; else it may be some samples older.
  void propagate() {
    if (interval_s_ > 0) propagate_covariance();
  }
  /// Goes on from another state at the time of the last sample, to which this one was propagated.
  void set_state(const InertialState& state) { state_ = state; }
  /// This filter on the way back, as of a sensor that turns and moves the other way: its samples are
  /// the reversed() ones from the last one on, which is its own already.
  [[nodiscard]] InertialFilter turned_back() const;
  /// Log likelihood of the pseudo-measurements since the last call; 0 where there were none.
  [[nodiscard]] double take_log_likelihood() { return std::exchange(log_likelihood_, 0); }

  [[nodiscard]] const Eigen::Quaterniond& world_from_imu() const { return state_.world_from_imu; }
  [[nodiscard]] const Eigen::Vector3d& bias() const { return state_.bias; }  ///< [rad/s]
  [[nodiscard]] double bias_sigma() const;  ///< of one component, RMS [rad/s]
  [[nodiscard]] double tilt_sigma() const;  ///< of one component, RMS [rad]
  [[nodiscard]] bool is_at_rest() const { return rest_.is_at_rest(); }
  /// Number of gaps longer than 0.1 s between samples.
  [[nodiscard]] int gaps() const { return gaps_; }

 private:
  void start(const ImuSample& sample);
  void integrate(const ImuSample& sample, double dt_s);
  void propagate_covariance();
  /// That three components of the state from `first` on are zero but for a `sigma` that lasts
  /// `time_s`, over an interval.
  void bound(int first, double sigma, double time_s, double interval_s);
  /// Kalman update by three components of the state from `first` on, with independent errors.
  void measure(int first, const Eigen::Vector3d& innovation, double variance);

  InertialFilterOptions options_;
  GyroscopeNoise gyroscope_;
  RestDetector rest_;
  InertialState state_;
  double log_likelihood_ = 0;
  ImuSample last_;
  bool has_last_ = false;
  int samples_since_update_ = 0;
  double interval_s_ = 0;                                ///< their duration
  Eigen::Vector3d force_sum_ = Eigen::Vector3d::Zero();  ///< their integral of R (f - c) [m/s]
  int gaps_ = 0;
};

}  // namespace saccade
