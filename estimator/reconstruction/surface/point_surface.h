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

/// The same, with planes chosen for squares of 2 x 2 pixels, in a quarter to half of the time: for pictures,
/// which hardly change by it. Between squares of one surface the depth is interpolated; contours are right to a pixel.
[[nodiscard]] ImageF coarse_surface_through(std::span<const SurfacePoint> points,
                                            const PinholeCamera& camera);

}  // namespace saccade
