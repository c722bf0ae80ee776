#pragma once

#include <span>

#include <Eigen/Core>

#include "core/camera.h"
#include "core/image.h"
#include "estimator/reconstruction/plane_labels.h"

namespace saccade {

/// A point that a surface is to pass through.
struct SurfacePoint {
  Eigen::Vector3d position;      ///< in the camera's frame [m]
  double relative_sigma = 0.01;  ///< deviation of its depth, as a share of it
};

/// A dense depth map [m] through single points, in `camera` (no lens), of planes: those around the
/// points and those that many of them lie on. Which of them a pixel belongs to is decided by
/// PlaneLabels; where surfaces are curved, the planes are small. Points from other views may be
/// hidden in this one. 0 everywhere where there is no point.
[[nodiscard]] ImageF surface_through(std::span<const SurfacePoint> points,
                                     const PinholeCamera& camera, const PlaneLabelOptions& options);

}  // namespace saccade
