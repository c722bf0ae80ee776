#include "estimator/rotation/rate_fusion.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"

namespace saccade {
namespace {

constexpr int kPriorWindows = 10;     ///< which the error stated at the start is worth
constexpr int kMemoryWindows = 100;   ///< over which the error is learned
constexpr double kOutlier = 5;        ///< deviations
constexpr double kLeastShare = 0.01;  ///< of the stated variance, which no luck falls below

}  // namespace

RateFusion::RateFusion(const RateFusionOptions& options)
    : options_(options),
      bias_variance_(
          Eigen::Vector3d::Constant(options.gyroscope.bias_sigma * options.gyroscope.bias_sigma)),
      events_variance_(
          Eigen::Vector3d::Constant(options.events_sigma_px * options.events_sigma_px)) {}

Eigen::Vector3d RateFusion::fuse(const RatePair& pair) {
  SACCADE_CHECK(pair.averaged_s > 0 && pair.px_per_rate > 0);
  const double walk = options_.gyroscope.random_walk;
  if (last_s_) bias_variance_.array() += walk * walk * (pair.t_s - *last_s_);
  last_s_ = pair.t_s;
  const double density = options_.gyroscope.density;
  const double gyro_variance = density * density / pair.averaged_s;
  const double px2 = pair.px_per_rate * pair.px_per_rate;
  windows_ = std::min(windows_ + 1, kMemoryWindows);
  const double least = kLeastShare * options_.events_sigma_px * options_.events_sigma_px;
  Eigen::Vector3d rate;
  for (int k = 0; k < 3; ++k) {
    const double of_gyroscope = bias_variance_[k] + gyro_variance;
    const double of_events = events_variance_[k] / px2;
    const double sum = of_gyroscope + of_events;
    const double difference = pair.gyroscope[k] - pair.events[k] - bias_[k];
    const double square = std::min(difference * difference, kOutlier * kOutlier * sum);
    const double learned = std::max((square - of_gyroscope) * px2, -events_variance_[k]);
    events_variance_[k] += (learned - events_variance_[k]) / (kPriorWindows + windows_);
    events_variance_[k] = std::max(events_variance_[k], least);
    rate[k] = pair.gyroscope[k] - bias_[k];
    if (std::abs(difference) > kOutlier * std::sqrt(sum)) continue;
    rate[k] -= of_gyroscope / sum * difference;
    const double gain = bias_variance_[k] / sum;
    bias_[k] += gain * difference;
    bias_variance_[k] *= 1 - gain;
  }
  return rate;
}

Eigen::Vector3d RateFusion::bias_sigma() const { return bias_variance_.cwiseSqrt(); }

Eigen::Vector3d RateFusion::events_sigma_px() const { return events_variance_.cwiseSqrt(); }

}  // namespace saccade
