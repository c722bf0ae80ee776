#include "estimator/imu/steady_bias.h"

#include <cmath>

namespace saccade {

SteadyBias::SteadyBias(const SteadyBiasOptions& options, double gravity)
    : options_(options),
      rest_(options.rest, gravity, options.noise.density),
      variance_(options.noise.bias_sigma * options.noise.bias_sigma) {}

void SteadyBias::add(const ImuSample& sample, double dt_s) {
  if (!options_.estimate) return;
  variance_ += options_.noise.random_walk * options_.noise.random_walk * dt_s;
  const auto window = rest_.add(sample, dt_s, bias_, sigma());
  if (!window) return;
  const double mean_variance = options_.noise.density * options_.noise.density / window->length_s;
  const double gain = options_.gain.value_or(variance_ / (variance_ + mean_variance));
  bias_ += gain * (window->mean_rate - bias_);
  variance_ = (1 - gain) * (1 - gain) * variance_ + gain * gain * mean_variance;
}

double SteadyBias::sigma() const { return std::sqrt(variance_); }

}  // namespace saccade
