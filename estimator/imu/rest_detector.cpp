#include "estimator/imu/rest_detector.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"

namespace saccade {

RestDetector::RestDetector(const RestOptions& options, double gravity, double gyro_noise)
    : options_(options), gravity_(gravity), gyro_noise_(gyro_noise) {}

std::optional<RestWindow> RestDetector::add(const ImuSample& sample, double dt_s,
                                            const Eigen::Vector3d& bias, double bias_sigma) {
  SACCADE_CHECK(dt_s > 0);
  force_sum_ += dt_s * sample.specific_force;
  rate_sum_ += dt_s * sample.angular_velocity;
  length_s_ += dt_s;
  // Steps of a thousandth of a second do not add up to a tenth to the last bit.
  if (length_s_ < options_.window_s * (1 - 1e-9)) return std::nullopt;
  constexpr double kDeviations = 4;
  const RestWindow window{rate_sum_ / length_s_, length_s_};
  const Eigen::Vector3d force = force_sum_ / length_s_;
  const double variance = gyro_noise_ * gyro_noise_ / length_s_;
  const double gate =
      std::min(options_.rate, kDeviations * std::sqrt(3 * (bias_sigma * bias_sigma + variance)));
  is_at_rest_ = previous_rate_ && std::abs(force.norm() - gravity_) < options_.accel &&
                (window.mean_rate - bias).norm() < gate &&
                (window.mean_rate - *previous_rate_).norm() < options_.rate_change;
  const bool at_rest = is_at_rest_;
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
