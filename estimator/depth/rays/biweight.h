#pragma once

namespace saccade {

/// Cut-off of Tukey's biweight in standard deviations: 95 % efficient on Gaussian residuals.
/// Residuals beyond it have no weight.
inline constexpr float kBiweightCutoff = 4.685F;

/// sigma^2 / (sum w r^2 / sum w) of Gaussian residuals under the biweight.
inline constexpr double kBiweightVariance = 1.29;

}  // namespace saccade
