#pragma once

#include <optional>

#include <Eigen/Core>

#include "core/imu_sample.h"

namespace saccade {

struct RestOptions {
  double window_s = 0.1;      ///< readings are judged by their mean over windows of this length
  double accel = 0.2;         ///< at rest below this | |a| - g | [m/s^2]
  double rate = 0.15;         ///< and below this |w - bias| [rad/s], while the bias is unknown
  double rate_change = 0.03;  ///< and below this change of w from window to window [rad/s]
};

/// A window in which the sensor did not move.
struct RestWindow {
  Eigen::Vector3d mean_rate = Eigen::Vector3d::Zero();  ///< as read [rad/s]
  double length_s = 0;
};

/// Finds windows of readings in which the sensor was at rest: the accelerometer reads gravity, the
/// rate is what the bias may be (at most `rate`, and within four deviations), and it is what it was
/// in the window before. A sensor that turns slowly and evenly from the first moment on cannot be
/// told from one at rest.
class RestDetector {
 public:
  /// `gyro_noise` [rad/s/sqrt(Hz)].
  RestDetector(const RestOptions& options, double gravity, double gyro_noise);

  /// A reading that stood for `dt_s` > 0, with what is known of the gyroscope's bias: its value and
  /// the deviation of a component [rad/s]. The window that the reading closed, if it was one of
  /// rest.
  std::optional<RestWindow> add(const ImuSample& sample, double dt_s, const Eigen::Vector3d& bias,
                                double bias_sigma);

  /// Drops the window in work, as after a gap.
  void interrupt();

  [[nodiscard]] bool is_at_rest() const { return is_at_rest_; }  ///< in the last window

 private:
  RestOptions options_;
  double gravity_;
  double gyro_noise_;
  double length_s_ = 0;  ///< of the window in work
  Eigen::Vector3d force_sum_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d rate_sum_ = Eigen::Vector3d::Zero();
  std::optional<Eigen::Vector3d> previous_rate_;
  bool is_at_rest_ = false;
};

}  // namespace saccade
