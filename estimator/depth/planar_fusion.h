#pragma once

#include <vector>

#include "estimator/depth/depth_estimator.h"

namespace saccade {

struct FusionOptions {
  double radius_px = 7;  ///< 0: no fusion
  int iterations = 4;
  int min_neighbours = 3;  ///< least sum of weights of the others; a point with fewer is dropped
  double model_error = 0.001;  ///< of a surface from its tangent plane, relative, added to sigma
  double sigma_scale = 1;      ///< on the fused deviation: neighbours share events
  double disagreement = 1;     ///< share of a point\'s distance from its plane that counts as error
  double floor = 0.0003;       ///< of sigma, relative: errors that all neighbours have in common
};

/// Replaces each inverse depth by that of the plane through its neighbours. The inverse depth of a
/// plane is linear in the pixel,
///   rho(x) = rho_0 + g . (x - x_0),
/// fitted by weighted least squares with Tukey's biweight from the point's own value on, so that
/// what lies beyond a depth step has no say. Points that their neighbourhood does not support, or
/// that stand out of it, are dropped.
[[nodiscard]] std::vector<EdgeDepth> fused(const std::vector<EdgeDepth>& points,
                                           const FusionOptions& options);

}  // namespace saccade
