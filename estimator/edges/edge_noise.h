#pragma once

#include <algorithm>

#include "estimator/depth/rays/event_assignment.h"
#include "estimator/edges/edge_residual.h"

namespace saccade {

/// The noise model of the event-to-edge residual r (edge_residual.h): an event scatters about its edge
/// by a Gaussian of sigma = sigma_px(), and outliers have Cauchy's loss
///   a^2 ln(1 + (r / (a sigma))^2),   a = kCauchyScale.
/// An edge's own unknowns have Gaussian priors of the sigmas below: c, m, h and (in the batch adjustment
/// alone) k about 0, rho about the regressed or a landmark's inverse depth. The joint solution of the
/// window adjustment has Cauchy's loss on them, too; its final fit_edge(), and all others, have none.
struct EdgeNoise {
  static constexpr double kMinSigma_px = 0.1;
  static constexpr double kCauchyScale = 2;
  static constexpr double kOffsetSigma_px = 2;        ///< of c
  static constexpr double kTiltSigma = 0.3;           ///< of m
  static constexpr double kHysteresisSigma_px = 0.5;  ///< of h
  static constexpr double kRunSpacingSigma_px = 0.5;  ///< of k (edge_bundle.h)

  /// Standard deviation of an edge's events: what the regression left of them, but no less than the
  /// sensor's own.
  [[nodiscard]] static double sigma_px(const FittedEdgel& edge) {
    return std::max(kMinSigma_px, static_cast<double>(edge.residual_px));
  }

  /// Sigmas of rho, c, m and h. That of rho is as large as rho: it hardly constrains the depth.
  [[nodiscard]] static EdgeUnknowns prior_sigma(double inverse_depth) {
    return {inverse_depth, kOffsetSigma_px, kTiltSigma, kHysteresisSigma_px};
  }
};

}  // namespace saccade
