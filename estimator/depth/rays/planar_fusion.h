#pragma once

#include <vector>

#include "core/config/fields.h"
#include "estimator/depth/depth_estimator.h"
#include "estimator/depth/rays/local_planes.h"

namespace saccade {

struct FusionOptions {
  PlaneOptions plane;
  /// Whether planes of few points are fitted to those of a wider neighbourhood (LocalPlanes::fit_widened).
  bool widens = false;
  int min_neighbours = 2;
  double max_sigma = 0.012;
  double position_sigma_px =
      0.4;  ///< u: error of a point's pixel, which matters on slanted surfaces
};

void describe(config::Fields& fields, FusionOptions& options);

/// The points that agree with their neighbourhood; see fuse_planes().
[[nodiscard]] std::vector<EdgePoint> supported_points(const std::vector<EdgePoint>& points,
                                                      const FusionOptions& options);

/// Replaces each inverse depth by that of the plane through its neighbours (LocalPlanes). Points
/// without enough neighbours, and outliers of their plane, are dropped. With s the standard deviation
/// of the plane at the point (times the spread k of its neighbours), w the sum of their weights, g
/// the plane's slope, d the point's distance from it and s_0 its sigma before,
///   sigma^2 = (a s)^2 (1 + (w_0 / w)^2) + rho^2 ((m w_0 / w)^2 + f^2)
///           + (u |g|)^2 + (o d)^2 + (c s_0)^2 (k^2 - 1):
/// few points say little about their scatter, and often lie on one edge; a point's pixel is known to
/// a fraction of a pixel; and neighbours that scatter more than their sigmas are no plane. A point
/// where its surface ends in front of another (LocalPlanes::surface_side) lies within a fraction of a
/// pixel of either, so it is shifted onto its own.
/// What the noise of the poses does to a point's depth it does to its neighbours', too, and is added
/// to sigma^2 after the fusion.
[[nodiscard]] std::vector<EdgePoint> fuse_planes(const std::vector<EdgePoint>& points,
                                                 const FusionOptions& options);

}  // namespace saccade
