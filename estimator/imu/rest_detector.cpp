#include "estimator/imu/rest_detector.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"

namespace saccade {
namespace {

// Over 0.1 s the noise of a consumer sensor averages to 0.03 m/s^2 and 0.003 rad/s: the thresholds
// are several sigma of it, and far below what a hand does.
constexpr double kRestWindow_s = 0.1;
constexpr double kMaxForceError = 0.2;  ///< of the mean force's magnitude from gravity [m/s^2]
constexpr double kMaxRate = 0.15;       ///< of the mean rate from the bias, once unknown [rad/s]
constexpr double kGateSigmas = 4;
/// Of a consumer accelerometer [m/s^2/sqrt(Hz)].
constexpr double kForceNoiseDensity = 1e-2;

}  // namespace

std::optional<RestWindow> RestDetector::add(const ImuSample& sample, double dt_s,
                                            const Eigen::Vector3d& bias, double bias_sigma) {
  SACCADE_CHECK(dt_s > 0);
  sums_.force += dt_s * sample.specific_force;
  sums_.rate += dt_s * sample.angular_velocity;
  length_s_ += dt_s;
  // A hundred intervals of 1 ms do not sum to 0.1 s to the last bit.
  if (length_s_ < kRestWindow_s * (1 - 1e-9)) return std::nullopt;
  const Means now{sums_.force / length_s_, sums_.rate / length_s_};
  const double length_s = length_s_;
  windows_[count_++ % kWindows] = now;
  length_s_ = 0;
  sums_ = {};
  const double variance = gyro_noise_density_ * gyro_noise_density_ / length_s;
  const double gate =
      std::min(kMaxRate, kGateSigmas * std::sqrt(3 * (bias_sigma * bias_sigma + variance)));
  const bool was_at_rest = is_at_rest_;
  is_at_rest_ = std::abs(now.force.norm() - kGravity_m_s2) < kMaxForceError &&
                (now.rate - bias).norm() < gate && is_steady();
  if (!is_at_rest_) return std::nullopt;
  if (was_at_rest) return RestWindow{now.rate, length_s};
  RestWindow rest{Eigen::Vector3d::Zero(), kWindows * length_s};
  for (const Means& window : windows_) rest.mean_rate += window.rate / kWindows;
  return rest;
}

bool RestDetector::is_steady() const {
  if (count_ < kWindows) return false;
  Means mean;
  for (const Means& window : windows_) {
    mean.force += window.force / kWindows;
    mean.rate += window.rate / kWindows;
  }
  double force_squares = 0, rate_squares = 0;
  for (const Means& window : windows_) {
    force_squares += (window.force - mean.force).squaredNorm();
    rate_squares += (window.rate - mean.rate).squaredNorm();
  }
  // Sums of squares of so many independent components of noise, by their mean and deviation.
  constexpr double kFreedom = 3 * (kWindows - 1);
  const double most = kFreedom + kGateSigmas * std::sqrt(2 * kFreedom);
  const auto limit = [&](double density) { return most * density * density / kRestWindow_s; };
  return force_squares < limit(kForceNoiseDensity) && rate_squares < limit(gyro_noise_density_);
}

void RestDetector::interrupt() {
  length_s_ = 0;
  sums_ = {};
  count_ = 0;
  is_at_rest_ = false;
}

}  // namespace saccade
