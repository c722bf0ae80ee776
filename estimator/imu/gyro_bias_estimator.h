#pragma once

#include <cmath>

#include <Eigen/Core>

#include "core/imu_sample.h"
#include "estimator/imu/rest_detector.h"

namespace saccade {

/// Noise of a gyroscope, in Kalibr's meaning.
struct GyroscopeNoise {
  double density = 1e-3;      ///< [rad/s/sqrt(Hz)]
  double random_walk = 2e-5;  ///< [rad/s^2/sqrt(Hz)]
  /// Of one component of the bias at the start [rad/s]: some degrees per second, the zero-rate
  /// offset of a consumer gyroscope. The first rest replaces it.
  double bias_sigma = 0.1;
};

/// The bias of a gyroscope, measured while the sensor is at rest (thesis 3.1.3), window by window:
///   bias <- bias + alpha_bias (w - bias)                                                    (3.17)
/// (printed without the previous bias). With P the variance of the bias and R that of the window's
/// mean, alpha_bias = P / (P + R), the gain of a Kalman filter: the estimate is the mean over the
/// rest so far, and later windows change it less and less.
class GyroBiasEstimator {
 public:
  explicit GyroBiasEstimator(const GyroscopeNoise& noise)
      : noise_(noise), rest_(noise.density), variance_(noise.bias_sigma * noise.bias_sigma) {}

  /// Adds a sample that holds for `dt_s` > 0.
  void add(const ImuSample& sample, double dt_s) {
    variance_ += noise_.random_walk * noise_.random_walk * dt_s;
    const auto rest = rest_.add(sample, dt_s, bias_, sigma());
    if (!rest) return;
    const double mean_variance = rest->rate_sigma * rest->rate_sigma;
    const double gain = variance_ / (variance_ + mean_variance);
    bias_ += gain * (rest->mean_rate - bias_);  // (3.17)
    variance_ = (1 - gain) * (1 - gain) * variance_ + gain * gain * mean_variance;
  }

  /// Forgets what was measured towards a rest, as after a gap.
  void interrupt() { rest_.interrupt(); }

  [[nodiscard]] const Eigen::Vector3d& bias() const { return bias_; }  ///< [rad/s]
  [[nodiscard]] double sigma() const { return std::sqrt(variance_); }  ///< of one component [rad/s]
  [[nodiscard]] bool is_at_rest() const { return rest_.is_at_rest(); }  ///< in the last window

 private:
  GyroscopeNoise noise_;
  RestDetector rest_;
  Eigen::Vector3d bias_ = Eigen::Vector3d::Zero();
  double variance_;  ///< P [rad^2/s^2]
};

}  // namespace saccade
