#pragma once

#include <algorithm>
#include <cmath>

#include <Eigen/Core>

namespace saccade {

/// The trust region of Levenberg-Marquardt (Madsen et al., Methods for Non-Linear Least Squares
/// Problems, 2004, section 3.2), with the constants of Ceres.
class TrustRegion {
 public:
  static constexpr double kMinRelativeDecrease = 1e-3;  ///< of the cost, to the model's: a step

  /// What is added to the normal equations' diagonal d: d / radius. Unknowns that hardly change
  /// any residual are damped as if they did a little, of columns scaled by 1 / (1 + norm).
  [[nodiscard]] double damping(double diagonal) const {
    constexpr double kMinScaled = 1e-6;
    const double scale = 1 + std::sqrt(diagonal);
    return std::max(diagonal, kMinScaled * scale * scale) / radius_;
  }

  /// After a step that made the cost fall by `ratio` times what the model said.
  void accept(double ratio) {
    constexpr double kMaxRadius = 1e16;
    const double surprise = 2 * ratio - 1;
    radius_ = std::min(kMaxRadius, radius_ / std::max(1.0 / 3, 1 - surprise * surprise * surprise));
    decrease_ = 2;
  }
  void reject() {
    radius_ /= decrease_;
    decrease_ *= 2;
  }
  [[nodiscard]] bool is_exhausted() const { return radius_ < 1e-32; }

 private:
  double radius_ = 1e4;
  double decrease_ = 2;
};

}  // namespace saccade
