#pragma once

#include <optional>

#include <Eigen/Core>

#include "estimator/imu/steady_bias.h"

namespace saccade {

struct RateFusionOptions {
  GyroscopeNoise gyroscope;
  double events_sigma_px =
      0.05;  ///< error of the events at the start, as they would be moved by it
};

/// What both sensors say of one window, in camera axes.
struct RatePair {
  double t_s = 0;          ///< middle of the window
  double averaged_s = 0;   ///< over which the gyroscope was averaged, in effect, > 0
  double px_per_rate = 0;  ///< by how much the window's events move at 1 rad/s, RMS [px], > 0
  Eigen::Vector3d gyroscope = Eigen::Vector3d::Zero();  ///< in the middle [rad/s]
  Eigen::Vector3d events = Eigen::Vector3d::Zero();     ///< [rad/s]
};

/// Angular velocity w and bias b of the gyroscope from gyroscope and events:
///   gyroscope = w + b + N(0, density^2 / averaged_s),  b a random walk,
///   events    = w + N(0, (s / px_per_rate)^2),
/// nothing being known of w beforehand. Their difference measures the bias (Kalman), and w is the
/// mean of events and gyroscope - b by their variances. s, the error of the events in pixels, is
/// learned per axis from how much larger the differences are than the gyroscope explains; one that
/// is beyond five deviations is an outlier, where the gyroscope stands alone.
class RateFusion {
 public:
  explicit RateFusion(const RateFusionOptions& options);

  /// The angular velocity of a window [rad/s]; windows in order of time.
  Eigen::Vector3d fuse(const RatePair& pair);
  /// Likewise where the events say nothing.
  [[nodiscard]] Eigen::Vector3d without_events(const Eigen::Vector3d& gyroscope) const {
    return gyroscope - bias_;
  }

  [[nodiscard]] const Eigen::Vector3d& bias() const { return bias_; }  ///< camera axes [rad/s]
  [[nodiscard]] Eigen::Vector3d bias_sigma() const;                    ///< [rad/s]
  [[nodiscard]] Eigen::Vector3d events_sigma_px() const;               ///< s

 private:
  RateFusionOptions options_;
  std::optional<double> last_s_;
  Eigen::Vector3d bias_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d bias_variance_;
  Eigen::Vector3d events_variance_;  ///< s^2 [px^2]
  int windows_ = 0;                  ///< that s was learned from
};

}  // namespace saccade
