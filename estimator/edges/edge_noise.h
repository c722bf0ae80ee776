#pragma once

#include <algorithm>

#include "estimator/depth/rays/event_assignment.h"
#include "estimator/edges/edge_residual.h"

namespace saccade {

/// The noise model of the event-to-edge residual (edge_residual.h), the same in every adjustment:
/// an event scatters about its edge by a Gaussian of sigma_px(), outliers by Cauchy's loss
///   rho(r) = a^2 ln(1 + (r / (a sigma))^2),   a = kCauchyScale,
/// and an edge's own unknowns have Gaussian priors with the sigmas below: c, m, h and k about 0, rho about
/// the regressed depth or, in the window adjustment, that of a landmark, there with Cauchy's loss. One
/// set of values serves ideal and noisy sensors and all adjustments.
struct EdgeNoise {
  static constexpr double kMinSigma_px = 0.1;
  static constexpr double kCauchyScale = 2;
  static constexpr double kOffsetSigma_px = 2;        ///< of c
  static constexpr double kTiltSigma = 0.3;           ///< of m
  static constexpr double kHysteresisSigma_px = 0.5;  ///< of h
  static constexpr double kRunSpacingSigma_px = 0.5;  ///< of k (path_edge_cost.h)

  /// Standard deviation of an edge's events: what the regression left of them, but no less than the
  /// sensor's own.
  [[nodiscard]] static double sigma_px(const FittedEdgel& edge) {
    return std::max(kMinSigma_px, static_cast<double>(edge.residual_px));
  }

  /// Sigmas of rho, c, m and h: the depth is known to its own size alone, next to nothing.
  [[nodiscard]] static EdgeUnknowns prior_sigma(double inverse_depth) {
    return {inverse_depth, kOffsetSigma_px, kTiltSigma, kHysteresisSigma_px};
  }
};

}  // namespace saccade
