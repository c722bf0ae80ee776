#pragma once

#include <optional>

#include <Eigen/Core>

#include "core/imu_sample.h"

namespace saccade {

/// Magnitude of gravity that the orientation filters assume [m/s^2].
constexpr double kGravity_m_s2 = 9.81;
/// After a longer gap between samples the orientation filters read the tilt again.
constexpr double kMaxImuGap_s = 0.1;

/// A window in which the sensor did not move.
struct RestWindow {
  Eigen::Vector3d mean_rate = Eigen::Vector3d::Zero();  ///< as measured [rad/s]
  double length_s = 0;
};

/// Finds windows of 0.1 s in which the sensor was at rest (steady state of thesis 3.1.3): the mean
/// specific force has the magnitude of gravity, the mean rate is a possible bias (below 0.15 rad/s
/// and within four sigma), and it equals that of the window before. A slow rotation at a constant
/// rate from the first moment on cannot be told from rest.
class RestDetector {
 public:
  /// `gyro_noise_density` [rad/s/sqrt(Hz)].
  explicit RestDetector(double gyro_noise_density) : gyro_noise_density_(gyro_noise_density) {}

  /// Adds a sample that holds for `dt_s` > 0. `bias`, `bias_sigma`: what is known of the
  /// gyroscope's bias, and the sigma of one component [rad/s]. Returns the window that this sample
  /// completes, if the sensor was at rest in it.
  std::optional<RestWindow> add(const ImuSample& sample, double dt_s, const Eigen::Vector3d& bias,
                                double bias_sigma);

  /// Discards the unfinished window, as after a gap.
  void interrupt();

  [[nodiscard]] bool is_at_rest() const { return is_at_rest_; }  ///< in the last window

 private:
  double gyro_noise_density_;
  double length_s_ = 0;  ///< of the unfinished window
  Eigen::Vector3d force_sum_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d rate_sum_ = Eigen::Vector3d::Zero();
  std::optional<Eigen::Vector3d> previous_rate_;
  bool is_at_rest_ = false;
};

}  // namespace saccade
