#include "estimator/imu/rest_detector.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"

namespace saccade {
namespace {

// Over 0.1 s the noise of a consumer sensor averages to 0.03 m/s^2 and 0.003 rad/s: the thresholds
// are several sigma of it, and far below what a hand does.
constexpr double kRestWindow_s = 0.1;
constexpr double kMaxRate = 0.15;  ///< of the mean rate from the bias, once unknown [rad/s]
constexpr double kGateSigmas = 4;
/// Nearly at rest the rate changes by this from one window to the next, and is as far from the bias
/// [rad/s]; it is worth saying where less is known of the bias than this.
constexpr double kNearRest = 0.03, kUnknownBias = 0.05;
/// Of a good accelerometer [m/s^2/sqrt(Hz)]; of a noisier one, or one that vibrates, its samples tell.
constexpr double kForceNoiseDensity = 1e-2;

}  // namespace

std::optional<Rest> RestDetector::add(const ImuSample& sample, double dt_s,
                                      const Eigen::Vector3d& bias, double bias_sigma) {
  SACCADE_CHECK(dt_s > 0);
  if (last_force_) difference_squares_ += (sample.specific_force - *last_force_).squaredNorm();
  last_force_ = sample.specific_force;
  force_sum_ += dt_s * sample.specific_force;
  rate_sum_ += dt_s * sample.angular_velocity;
  may_rest_ = may_rest_ && sample.may_rest;
  length_s_ += dt_s;
  ++samples_;
  // A hundred intervals of 1 ms do not sum to 0.1 s to the last bit.
  if (length_s_ < kRestWindow_s * (1 - 1e-9)) return std::nullopt;
  // The difference of two samples has twice the variance of one, in three components.
  const auto n = static_cast<double>(samples_);
  const Window now{length_s_, force_sum_ / length_s_, rate_sum_ / length_s_, may_rest_,
                   difference_squares_ / (6 * n * n)};
  start_window();
  windows_[count_++ % kWindows] = now;
  unreturned_ = std::min(unreturned_ + 1, kWindows);
  const double variance = gyro_noise_density_ * gyro_noise_density_ / now.length_s;
  const double gate =
      std::min(kMaxRate, kGateSigmas * std::sqrt(3 * (bias_sigma * bias_sigma + variance)));
  is_at_rest_ = std::abs(now.force.norm() - kGravity_m_s2) < kMaxForceError &&
                (now.rate - bias).norm() < gate && is_steady();
  if (!is_at_rest_) return near_rest(bias_sigma);
  has_begun_ = true;
  Rest rest;
  for (; unreturned_ > 0; --unreturned_) {
    const Window& window = windows_[(count_ - unreturned_) % kWindows];
    rest.mean_rate += window.length_s * window.rate;
    rest.length_s += window.length_s;
  }
  rest.mean_rate /= rest.length_s;
  rest.rate_sigma = gyro_noise_density_ / std::sqrt(rest.length_s);
  return rest;
}

std::optional<Rest> RestDetector::near_rest(double bias_sigma) {
  if (has_begun_ || count_ < 2 || bias_sigma < kUnknownBias) return std::nullopt;
  const Window& now = windows_[(count_ - 1) % kWindows];
  const Window& before = windows_[(count_ - 2) % kWindows];
  for (const Window* window : {&before, &now})
    if (!window->may_rest || std::abs(window->force.norm() - kGravity_m_s2) > kMaxForceError ||
        window->rate.norm() > kMaxRate)
      return std::nullopt;
  if ((now.rate - before.rate).norm() > kNearRest) return std::nullopt;
  has_begun_ = true;
  return Rest{0.5 * (now.rate + before.rate), now.length_s + before.length_s, kNearRest, false};
}

bool RestDetector::is_steady() const {
  if (count_ < kWindows) return false;
  Window mean;
  double force_noise = 0;
  for (const Window& window : windows_) {
    if (!window.may_rest) return false;
    mean.force += window.force / kWindows;
    mean.rate += window.rate / kWindows;
    force_noise += window.force_variance / kWindows;
  }
  double force_squares = 0, rate_squares = 0;
  for (const Window& window : windows_) {
    force_squares += (window.force - mean.force).squaredNorm();
    rate_squares += (window.rate - mean.rate).squaredNorm();
  }
  // Sums of squares of so many independent components of noise, by their mean and deviation.
  constexpr double kFreedom = 3 * (kWindows - 1);
  const double most = kFreedom + kGateSigmas * std::sqrt(2 * kFreedom);
  const auto variance = [](double density) { return density * density / kRestWindow_s; };
  return force_squares < most * std::max(variance(kForceNoiseDensity), force_noise) &&
         rate_squares < most * variance(gyro_noise_density_);
}

void RestDetector::start_window() {
  length_s_ = 0;
  samples_ = 0;
  force_sum_.setZero();
  rate_sum_.setZero();
  difference_squares_ = 0;
  may_rest_ = true;
}

void RestDetector::interrupt() {
  start_window();
  last_force_.reset();
  count_ = 0;
  unreturned_ = 0;
  is_at_rest_ = false;
}

}  // namespace saccade
