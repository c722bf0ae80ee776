#include "estimator/imu/gyro_bias_estimator.h"

#include <cmath>

namespace saccade {

GyroBiasEstimator::GyroBiasEstimator(const GyroscopeNoise& noise)
    : noise_(noise), rest_(noise.density), variance_(noise.bias_sigma * noise.bias_sigma) {}

void GyroBiasEstimator::add(const ImuSample& sample, double dt_s) {
  variance_ += noise_.random_walk * noise_.random_walk * dt_s;
  const auto window = rest_.add(sample, dt_s, bias_, sigma());
  if (!window) return;
  const double mean_variance = noise_.density * noise_.density / window->length_s;
  const double gain = variance_ / (variance_ + mean_variance);
  bias_ += gain * (window->mean_rate - bias_);  // (3.17)
  variance_ = (1 - gain) * (1 - gain) * variance_ + gain * gain * mean_variance;
}

double GyroBiasEstimator::sigma() const { return std::sqrt(variance_); }

}  // namespace saccade
