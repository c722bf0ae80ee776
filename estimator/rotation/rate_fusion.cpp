#include "estimator/rotation/rate_fusion.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"

namespace saccade {
namespace {

constexpr double kEventsSigma_px = 0.05;  ///< s at the start
constexpr int kPriorWindows = 10;         ///< number of windows that this value counts for
constexpr int kMemoryWindows = 100;       ///< over which s is averaged
constexpr double kOutlierSigmas = 5;
constexpr double kMinVarianceRatio = 0.01;  ///< of s^2 to its start, a guard against luck

}  // namespace

RateFusion::RateFusion(const GyroscopeNoise& gyroscope)
    : noise_(gyroscope),
      bias_variance_(Eigen::Vector3d::Constant(gyroscope.bias_sigma * gyroscope.bias_sigma)),
      events_variance_(Eigen::Vector3d::Constant(kEventsSigma_px * kEventsSigma_px)) {}

Eigen::Vector3d RateFusion::fuse(const RateMeasurements& measured) {
  SACCADE_CHECK(measured.averaged_s > 0 && measured.px_per_rate > 0);
  const double walk = noise_.random_walk;
  if (last_s_) bias_variance_.array() += walk * walk * (measured.t_s - *last_s_);
  last_s_ = measured.t_s;
  const double density = noise_.density;
  const double gyro_variance = density * density / measured.averaged_s;
  const double px2 = measured.px_per_rate * measured.px_per_rate;
  windows_ = std::min(windows_ + 1, kMemoryWindows);
  const double min_variance = kMinVarianceRatio * kEventsSigma_px * kEventsSigma_px;
  Eigen::Vector3d rate;
  for (int k = 0; k < 3; ++k) {
    const double gyro_rate_variance = bias_variance_[k] + gyro_variance;
    const double events_rate_variance = events_variance_[k] / px2;
    const double sum = gyro_rate_variance + events_rate_variance;
    const double difference = measured.gyroscope[k] - measured.events[k] - bias_[k];
    const double square = std::min(difference * difference, kOutlierSigmas * kOutlierSigmas * sum);
    const double unexplained = std::max((square - gyro_rate_variance) * px2, -events_variance_[k]);
    events_variance_[k] += (unexplained - events_variance_[k]) / (kPriorWindows + windows_);
    events_variance_[k] = std::max(events_variance_[k], min_variance);
    rate[k] = measured.gyroscope[k] - bias_[k];
    if (std::abs(difference) > kOutlierSigmas * std::sqrt(sum)) continue;
    rate[k] -= gyro_rate_variance / sum * difference;
    const double gain = bias_variance_[k] / sum;
    bias_[k] += gain * difference;
    bias_variance_[k] *= 1 - gain;
  }
  return rate;
}

Eigen::Vector3d RateFusion::bias_sigma() const { return bias_variance_.cwiseSqrt(); }

Eigen::Vector3d RateFusion::events_sigma_px() const { return events_variance_.cwiseSqrt(); }

}  // namespace saccade
