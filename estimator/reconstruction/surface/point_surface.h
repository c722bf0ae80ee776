#pragma once

#include <span>

#include <Eigen/Core>

#include "core/camera.h"
#include "core/image.h"

namespace saccade {

/// A point of a surface.
struct SurfacePoint {
  Eigen::Vector3d position;      ///< in the camera's frame [m]
  double relative_sigma = 0.01;  ///< standard deviation of its depth over the depth
};

/// A dense depth map [m] through sparse points, in `camera` (no lens), of planes: those fitted around
/// each point and those that many points lie on. PlaneLabels assigns them to pixels; curved surfaces
/// become small planes. Points from other views may be occluded in this one. 0 everywhere without any
/// point.
[[nodiscard]] ImageF surface_through(std::span<const SurfacePoint> points,
                                     const PinholeCamera& camera);

}  // namespace saccade
