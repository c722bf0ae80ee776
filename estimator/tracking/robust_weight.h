#pragma once

#include <algorithm>
#include <cmath>

namespace saccade {

/// Cauchy's weight 1 / (1 + (x / c)^2) of a normalised residual: those beyond this c weigh less
/// than half. 95 % efficient on Gaussian residuals.
inline constexpr double kCauchyScale = 2.4;

/// Weights of an M-estimator over residuals r of scale sigma.
enum class RobustWeight { kNone, kHuber, kTukey };

/// Square root of the weight of a normalised residual x = r / sigma (95 % efficient on Gaussian
/// residuals):
///   kHuber  w = min(1, 1.345 / |x|)
///   kTukey  w = (1 - (x / 4.685)^2)^2 for |x| < 4.685, else 0
[[nodiscard]] inline float sqrt_weight(RobustWeight kind, float x) {
  constexpr float kHuber = 1.345F;
  constexpr float kTukey = 4.685F;
  switch (kind) {
    case RobustWeight::kNone:
      return 1;
    case RobustWeight::kHuber:
      return std::sqrt(kHuber / std::max(std::abs(x), kHuber));
    case RobustWeight::kTukey:
      return std::max(0.0F, 1 - x * x / (kTukey * kTukey));
  }
  return 1;
}

}  // namespace saccade
