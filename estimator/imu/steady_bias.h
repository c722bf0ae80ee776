#pragma once

#include <optional>

#include <Eigen/Core>

#include "core/imu_sample.h"
#include "estimator/imu/rest_detector.h"

namespace saccade {

/// What is known of a gyroscope [rad/s].
struct GyroscopeNoise {
  double density = 1e-3;      ///< of its white noise [rad/s/sqrt(Hz)]
  double random_walk = 2e-5;  ///< of its bias [rad/s^2/sqrt(Hz)]
  double bias_sigma = 0.1;    ///< deviation of its bias at the start [rad/s]
};

struct SteadyBiasOptions {
  bool estimate = true;
  std::optional<double> gain;  ///< alpha_bias of (3.17) per window; nullopt: by the variances
  RestOptions rest;
  GyroscopeNoise noise;
};

/// The bias of a gyroscope, read while the sensor is at rest (thesis 3.1.3), window by window:
///   bias <- bias + alpha_bias (w - bias)                                                    (3.17)
/// (which is printed without the bias before). With P the variance of the bias and R that of a
/// window's mean, alpha_bias = P / (P + R): the mean over the rest so far, whatever its length, and
/// slower than any constant gain once it is known.
class SteadyBias {
 public:
  SteadyBias(const SteadyBiasOptions& options, double gravity);

  /// A reading that stood for `dt_s` > 0.
  void add(const ImuSample& sample, double dt_s);

  /// Drops the window in work, as after a gap.
  void interrupt() { rest_.interrupt(); }

  [[nodiscard]] const Eigen::Vector3d& bias() const { return bias_; }  ///< [rad/s]
  [[nodiscard]] double sigma() const;                                  ///< of one component [rad/s]
  [[nodiscard]] bool is_steady() const { return rest_.is_at_rest(); }  ///< in the last window

 private:
  SteadyBiasOptions options_;
  RestDetector rest_;
  Eigen::Vector3d bias_ = Eigen::Vector3d::Zero();
  double variance_;
};

}  // namespace saccade
