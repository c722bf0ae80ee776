#include "estimator/imu/rest_detector.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"

namespace saccade {
namespace {

// Over 0.1 s the noise of a consumer sensor averages to 0.03 m/s^2 and 0.003 rad/s: the thresholds
// are several sigma of it, and far below what a hand does.
constexpr double kRestWindow_s = 0.1;
constexpr double kMaxForceError = 0.2;   ///< of the mean force's magnitude from gravity [m/s^2]
constexpr double kMaxRate = 0.15;        ///< of the mean rate from the bias, once unknown [rad/s]
constexpr double kMaxRateChange = 0.03;  ///< from one window to the next [rad/s]
constexpr double kGateSigmas = 4;

}  // namespace

std::optional<RestWindow> RestDetector::add(const ImuSample& sample, double dt_s,
                                            const Eigen::Vector3d& bias, double bias_sigma) {
  SACCADE_CHECK(dt_s > 0);
  force_sum_ += dt_s * sample.specific_force;
  rate_sum_ += dt_s * sample.angular_velocity;
  length_s_ += dt_s;
  // A hundred intervals of 1 ms do not sum to 0.1 s to the last bit.
  if (length_s_ < kRestWindow_s * (1 - 1e-9)) return std::nullopt;
  const RestWindow window{rate_sum_ / length_s_, length_s_};
  const Eigen::Vector3d force = force_sum_ / length_s_;
  const double variance = gyro_noise_density_ * gyro_noise_density_ / length_s_;
  const double gate =
      std::min(kMaxRate, kGateSigmas * std::sqrt(3 * (bias_sigma * bias_sigma + variance)));
  const bool at_rest = previous_rate_ && std::abs(force.norm() - kGravity_m_s2) < kMaxForceError &&
                       (window.mean_rate - bias).norm() < gate &&
                       (window.mean_rate - *previous_rate_).norm() < kMaxRateChange;
  interrupt();
  previous_rate_ = window.mean_rate;
  is_at_rest_ = at_rest;
  if (!at_rest) return std::nullopt;
  return window;
}

void RestDetector::interrupt() {
  length_s_ = 0;
  force_sum_.setZero();
  rate_sum_.setZero();
  previous_rate_.reset();
  is_at_rest_ = false;
}

}  // namespace saccade
