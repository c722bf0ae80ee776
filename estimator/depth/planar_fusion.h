#pragma once

#include <vector>

#include "estimator/depth/depth_estimator.h"
#include "estimator/depth/local_planes.h"

namespace saccade {

struct FusionOptions {
  PlaneOptions plane;         ///< radius 0: no fusion
  int min_neighbours = 3;     ///< least sum of weights of the others; a point with fewer is dropped
  double max_sigma = 0.02;    ///< relative; points with more are dropped
  double sigma_scale = 1.25;  ///< a: neighbours share events
  double few_weights = 14;    ///< w_0: a plane through so few points has twice the variance
  double few_error = 0.002;   ///< m: of a surface through w_0 points, relative
  double floor = 0.0003;      ///< f, relative: errors that all neighbours have in common
};

/// Those of the points that their neighbourhood supports; see fused().
[[nodiscard]] std::vector<EdgeDepth> supported(const std::vector<EdgeDepth>& points,
                                               const FusionOptions& options);

/// Replaces each inverse depth by that of the plane through its neighbours (LocalPlanes). Points
/// that their neighbourhood does not support, or that stand out of it, are dropped. With s the
/// deviation of the plane at the point (times the spread of the points around it) and w the sum of
/// their weights,
///   sigma^2 = (a s)^2 (1 + (w_0 / w)^2) + rho^2 ((m w_0 / w)^2 + f^2):
/// few points say little about how far they scatter, and often lie on one edge.
[[nodiscard]] std::vector<EdgeDepth> fused(const std::vector<EdgeDepth>& points,
                                           const FusionOptions& options);

}  // namespace saccade
