#pragma once

#include <vector>

#include "estimator/depth/depth_estimator.h"
#include "estimator/depth/local_planes.h"

namespace saccade {

struct FusionOptions {
  PlaneOptions plane;         ///< radius 0: no fusion
  int min_neighbours = 2;     ///< least sum of weights of the others; a point with fewer is dropped
  double max_sigma = 0.02;    ///< relative, of the plane; points with more are dropped
  double sigma_scale = 1.1;   ///< a: neighbours share events
  double few_weights = 14;    ///< w_0: a plane through so few points has twice the variance
  double few_error = 0.0015;  ///< m: of a surface through w_0 points, relative
  double floor = 0.0004;      ///< f, relative: errors that all neighbours have in common
  double position_error_px = 0.4;  ///< u: of a point's place, felt where the surface is slanted
  double own_share = 0.4;          ///< o: of a point's distance from its plane
  double scatter_share = 0.15;     ///< c: of what the points around scatter beyond their sigmas
  double step_shift_px = 0.5;      ///< of a point on a contour, onto the surface that ends there
};

/// Those of the points that their neighbourhood supports; see fused().
[[nodiscard]] std::vector<EdgeDepth> supported(const std::vector<EdgeDepth>& points,
                                               const FusionOptions& options);

/// Replaces each inverse depth by that of the plane through its neighbours (LocalPlanes). Points
/// that their neighbourhood does not support, or that stand out of it, are dropped. With s the
/// deviation of the plane at the point (times the spread k of the points around it), w the sum of
/// their weights, g the plane's slope, d the point's distance from it and s_0 its sigma before,
///   sigma^2 = (a s)^2 (1 + (w_0 / w)^2) + rho^2 ((m w_0 / w)^2 + f^2)
///           + (u |g|)^2 + (o d)^2 + (c s_0)^2 (k^2 - 1):
/// few points say little about how far they scatter, and often lie on one edge; a point is a
/// fraction of a pixel beside its place; and a surface with more scatter than its points is no
/// plane. A point where its surface ends in front of another (surface_side) lies within a fraction
/// of a pixel of either: it is moved onto its own.
[[nodiscard]] std::vector<EdgeDepth> fused(const std::vector<EdgeDepth>& points,
                                           const FusionOptions& options);

}  // namespace saccade
