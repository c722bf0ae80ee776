#pragma once

namespace saccade {

/// Tukey's biweight leaves residuals beyond this many deviations out; 95 % efficient on Gaussian
/// ones.
inline constexpr float kBiweightReach = 4.685F;

/// sigma^2 / (sum w r^2 / sum w) of Gaussian residuals under the biweight.
inline constexpr double kBiweightVariance = 1.29;

}  // namespace saccade
