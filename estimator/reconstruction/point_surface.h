#pragma once

#include <span>

#include <Eigen/Core>

#include "core/camera.h"
#include "core/image.h"

namespace saccade {

/// A point that a surface is to pass through.
struct SurfacePoint {
  Eigen::Vector3d position;      ///< in the camera's frame [m]
  double relative_sigma = 0.01;  ///< deviation of its depth, as a share of it
};

/// A dense depth map [m] through single points, in `camera` (no lens): the log inverse depth r of
/// least total variation that agrees with them, found by reweighted least squares,
///   sum_i (r(u_i) - r_i)^2 / sigma_i^2 + sum over neighbours (r_a - r_b)^2 / (s^2 + s |r_a -
///   r_b|),
/// with s = `smoothness`, so that steps between points stay steps; points that disagree count less.
/// 0 everywhere where there is no point.
[[nodiscard]] ImageF surface_through(std::span<const SurfacePoint> points,
                                     const PinholeCamera& camera, double smoothness);

}  // namespace saccade
