#pragma once

#include <algorithm>
#include <cmath>

#include "simulator/sensor/signal/ray_sample.h"

namespace saccade {

/// The log intensity of a pixel at an instant.
struct LinearSample {
  double t_s = 0;
  double log_intensity = 0;  ///< ln(eps + mean radiance)
};

/// A pixel's log intensity as the straight line between two samples, for PixelSensor: crossings and
/// all models of noise are exact on it.
class LinearSignal {
 public:
  using Sample = LinearSample;

  LinearSignal(double log_eps, double tolerance_s) : log_eps_(log_eps), tolerance_s_(tolerance_s) {}

  [[nodiscard]] double tolerance_s() const { return tolerance_s_; }

  [[nodiscard]] Sample at(double t_s, const Sample& lo, const Sample& hi) const {
    const double fraction = (t_s - lo.t_s) / (hi.t_s - lo.t_s);
    return {t_s, std::lerp(lo.log_intensity, hi.log_intensity, fraction)};
  }

  [[nodiscard]] Sample divide(const Sample& lo, const Sample& hi, int /*depth*/) const {
    return at(0.5 * (lo.t_s + hi.t_s), lo, hi);
  }

  /// dI/dt = (eps + I) dL/dt, so radiance and rate are extreme at the ends.
  [[nodiscard]] RadianceRange range(const Sample& lo, const Sample& hi) const {
    const auto [low, high] = std::minmax({std::exp(lo.log_intensity), std::exp(hi.log_intensity)});
    const double slope = (hi.log_intensity - lo.log_intensity) / (hi.t_s - lo.t_s);
    const auto [rate_low, rate_high] = std::minmax({slope * low, slope * high});
    return {low - log_eps_, high - log_eps_, rate_low, rate_high};
  }

 private:
  double log_eps_;
  double tolerance_s_;
};

}  // namespace saccade
