#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include <Eigen/Core>

#include "core/imu_sample.h"

namespace saccade {

/// Magnitude of gravity that the orientation filters assume [m/s^2].
constexpr double kGravity_m_s2 = 9.81;
/// After a longer gap between samples the orientation filters read the tilt again.
constexpr double kMaxImuGap_s = 0.1;
/// Of the mean force's magnitude from gravity at rest [m/s^2]: two real cameras read 10.1 and 10.6.
constexpr double kMaxForceError = 0.9;

/// Time in which the sensor did not move.
struct Rest {
  Eigen::Vector3d mean_rate = Eigen::Vector3d::Zero();  ///< as measured [rad/s]
  double length_s = 0;
  double rate_sigma = 0;    ///< of a component of the mean rate as the bias [rad/s]
  bool is_complete = true;  ///< false: as good as at rest, but for slow movements
};

/// Finds when the sensor was at rest (steady state of thesis 3.1.3), by windows of 0.1 s: the mean
/// specific force has the magnitude of gravity, the mean rate is a possible bias (below 0.15 rad/s
/// and within four sigma), and over four windows in a row neither changes by more than noise does:
/// a turn that slows down, or that tilts the sensor, is none. A slow rotation about the vertical at
/// a constant rate cannot be told from rest but by ImuSample::may_rest. While nothing is known of
/// the bias, the first two windows of a slow and nearly constant rate tell it roughly: recordings
/// begin at rest more often than in a turn.
class RestDetector {
 public:
  /// `gyro_noise_density` [rad/s/sqrt(Hz)].
  explicit RestDetector(double gyro_noise_density) : gyro_noise_density_(gyro_noise_density) {}

  /// Adds a sample that holds for `dt_s` > 0. `bias`, `bias_sigma`: what is known of the
  /// gyroscope's bias, and the sigma of one component [rad/s]. Where this sample completes a window,
  /// and the sensor was at rest, returns that of the time at rest that was not returned before.
  std::optional<Rest> add(const ImuSample& sample, double dt_s, const Eigen::Vector3d& bias,
                          double bias_sigma);

  /// Forgets what was measured, as after a gap.
  void interrupt();

  [[nodiscard]] bool is_at_rest() const { return is_at_rest_; }  ///< in the last window

 private:
  struct Window {
    double length_s = 0;
    Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< mean
    Eigen::Vector3d rate = Eigen::Vector3d::Zero();   ///< mean
    bool may_rest = true;                             ///< ImuSample::may_rest of all
    double force_variance = 0;  ///< of a component of the mean, by what its samples differ
  };
  static constexpr std::size_t kWindows = 4;

  void start_window();
  /// What the last two windows say of a bias that nothing is known of.
  [[nodiscard]] std::optional<Rest> near_rest(double bias_sigma);
  /// Whether the last windows differ from one another by no more than noise.
  [[nodiscard]] bool is_steady() const;

  double gyro_noise_density_;
  // Of the unfinished window.
  double length_s_ = 0;
  std::size_t samples_ = 0;
  Eigen::Vector3d force_sum_ = Eigen::Vector3d::Zero();  ///< times the length
  Eigen::Vector3d rate_sum_ = Eigen::Vector3d::Zero();   ///< likewise
  bool may_rest_ = true;
  double difference_squares_ = 0;  ///< of the force, from one sample to the next

  std::optional<Eigen::Vector3d> last_force_;
  std::array<Window, kWindows> windows_;
  std::size_t count_ = 0;       ///< finished since the last interruption
  std::size_t unreturned_ = 0;  ///< the newest of them
  bool is_at_rest_ = false;
  bool has_begun_ = false;  ///< a rest was found, or what is near one
};

}  // namespace saccade
