#pragma once

#include <optional>

#include <Eigen/Core>

#include "core/event.h"
#include "core/imu_sample.h"

namespace saccade {

struct SteadyBiasOptions {
  bool estimate = true;
  double window_s = 0.1;       ///< readings are judged by their mean over windows of this length
  double accel = 0.2;          ///< steady below this | |a| - g | [m/s^2]
  double rate = 0.15;          ///< and below this |w - bias| [rad/s], while the bias is unknown
  double rate_change = 0.03;   ///< and below this change of w from window to window [rad/s]
  double sigma = 0.1;          ///< deviation of the bias at the start [rad/s]
  double noise = 1e-3;         ///< of the gyroscope [rad/s/sqrt(Hz)]
  double random_walk = 2e-5;   ///< of its bias [rad/s^2/sqrt(Hz)]
  std::optional<double> gain;  ///< alpha_bias of (3.17) per window; nullopt: by the variances
};

/// The bias of a gyroscope, read while the sensor is at rest (thesis 3.1.3):
///   bias <- bias + alpha_bias (w - bias) (3.17)
/// (which is printed without the bias before). With P the variance of the bias and R that of a
/// window's mean, alpha_bias = P / (P + R): the mean over the rest so far, whatever its length, and
/// slower than any constant gain once it is known. A window is taken for rest when the
/// accelerometer reads gravity, the rate is what the bias may be (at most `rate`, and within four
/// deviations), and it is what it was in the window before. A sensor that turns slowly and evenly
/// from the first moment on cannot be told from one at rest.
class SteadyBias {
 public:
  SteadyBias(const SteadyBiasOptions& options, double gravity);

  /// A reading that stood for `dt_s` > 0. True when it closed a window that was taken for rest.
  bool add(const ImuSample& sample, double dt_s);

  /// Drops the window in work, as after a gap.
  void interrupt();

  [[nodiscard]] const Eigen::Vector3d& bias() const { return bias_; }  ///< [rad/s]
  /// Of one component [rad/s].
  [[nodiscard]] double sigma() const;
  [[nodiscard]] bool is_steady() const { return is_steady_; }  ///< in the last window

 private:
  [[nodiscard]] bool looks_steady(const Eigen::Vector3d& force, const Eigen::Vector3d& rate,
                                  double mean_variance) const;

  SteadyBiasOptions options_;
  double gravity_;
  Eigen::Vector3d bias_ = Eigen::Vector3d::Zero();
  double variance_;
  double length_s_ = 0;  ///< of the window in work
  Eigen::Vector3d force_sum_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d rate_sum_ = Eigen::Vector3d::Zero();
  std::optional<Eigen::Vector3d> previous_rate_;
  bool is_steady_ = false;
};

}  // namespace saccade
