#include "estimator/imu/steady_bias.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"

namespace saccade {

SteadyBias::SteadyBias(const SteadyBiasOptions& options, double gravity)
    : options_(options), gravity_(gravity), variance_(options.sigma * options.sigma) {}

bool SteadyBias::add(const ImuSample& sample, double dt_s) {
  SACCADE_CHECK(dt_s > 0);
  if (!options_.estimate) return false;
  force_sum_ += dt_s * sample.specific_force;
  rate_sum_ += dt_s * sample.angular_velocity;
  length_s_ += dt_s;
  variance_ += options_.random_walk * options_.random_walk * dt_s;
  // Steps of a thousandth of a second do not add up to a tenth to the last bit.
  if (length_s_ < options_.window_s * (1 - 1e-9)) return false;
  const Eigen::Vector3d force = force_sum_ / length_s_;
  const Eigen::Vector3d rate = rate_sum_ / length_s_;
  const double mean_variance = options_.noise * options_.noise / length_s_;
  is_steady_ = looks_steady(force, rate, mean_variance);
  if (is_steady_) {
    const double gain = options_.gain.value_or(variance_ / (variance_ + mean_variance));
    bias_ += gain * (rate - bias_);
    variance_ = (1 - gain) * (1 - gain) * variance_ + gain * gain * mean_variance;
  }
  interrupt();
  previous_rate_ = rate;
  return is_steady_;
}

void SteadyBias::interrupt() {
  length_s_ = 0;
  force_sum_.setZero();
  rate_sum_.setZero();
  previous_rate_.reset();
}

double SteadyBias::sigma() const { return std::sqrt(variance_); }

bool SteadyBias::looks_steady(const Eigen::Vector3d& force, const Eigen::Vector3d& rate,
                              double mean_variance) const {
  constexpr double kDeviations = 4;
  if (!previous_rate_) return false;
  const double gate =
      std::min(options_.rate, kDeviations * std::sqrt(3 * (variance_ + mean_variance)));
  return std::abs(force.norm() - gravity_) < options_.accel && (rate - bias_).norm() < gate &&
         (rate - *previous_rate_).norm() < options_.rate_change;
}

}  // namespace saccade
