#include "estimator/depth/thesis/depth_filter.h"

#include <cmath>
#include <numbers>

namespace saccade {
namespace {

double normal_density(double error, double variance) {
  return std::exp(-error * error / (2 * variance)) / std::sqrt(2 * std::numbers::pi * variance);
}

}  // namespace

DepthBelief updated(const DepthBelief& belief, double measurement, double variance, double range) {
  const auto& [mu, s2, a, b] = belief;
  // Vogiatzis and Hernandez (2011), in inverse depth (5.14).
  const double n = a + b;
  const double fused_variance = 1 / (1 / s2 + 1 / variance);
  const double fused = fused_variance * (mu / s2 + measurement / variance);
  const double inlier = a / n * normal_density(measurement - mu, s2 + variance);
  const double outlier = b / n / range;
  const double c1 = inlier / (inlier + outlier);
  const double c2 = 1 - c1;

  const double f = c1 * (a + 1) / (n + 1) + c2 * a / (n + 1);
  const double e = (c1 * (a + 1) * (a + 2) + c2 * a * (a + 1)) / ((n + 1) * (n + 2));
  DepthBelief next;
  next.mean = c1 * fused + c2 * mu;
  // The same as the difference of second moments above, without its cancellation.
  const double between = fused - mu;
  next.variance = c1 * fused_variance + c2 * s2 + c1 * c2 * between * between;
  next.a = (e - f) / (f - e / f);
  next.b = next.a * (1 - f) / f;
  return next;
}

}  // namespace saccade
