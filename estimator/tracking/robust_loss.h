#pragma once

#include <algorithm>
#include <cmath>

namespace saccade {

/// Cauchy's weight 1 / (1 + (x / c)^2) of a normalised residual: those beyond this c weigh less
/// than half. 95 % efficient on Gaussian residuals.
inline constexpr double kCauchyScale = 2.4;

/// The loss of an M-estimator over residuals r of scale sigma.
enum class RobustLoss { kNone, kHuber, kTukey };

/// Square root of the weight of a normalised residual x = r / sigma (95 % efficient on Gaussian
/// residuals):
///   kHuber  w = min(1, 1.345 / |x|)
///   kTukey  w = (1 - (x / 4.685)^2)^2 for |x| < 4.685, else 0
[[nodiscard]] inline float sqrt_weight(RobustLoss kind, float x) {
  constexpr float kHuberThreshold = 1.345F;
  constexpr float kTukeyThreshold = 4.685F;
  switch (kind) {
    case RobustLoss::kNone:
      return 1;
    case RobustLoss::kHuber:
      return std::sqrt(kHuberThreshold / std::max(std::abs(x), kHuberThreshold));
    case RobustLoss::kTukey:
      return std::max(0.0F, 1 - x * x / (kTukeyThreshold * kTukeyThreshold));
  }
  return 1;
}

}  // namespace saccade
