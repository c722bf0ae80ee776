#pragma once

#include <Eigen/Core>

#include "core/camera.h"
#include "core/rigid3.h"
#include "core/spline/spline.h"

namespace saccade {

/// Twist (v, w) of the camera in its own frame [m/s, rad/s].
[[nodiscard]] Twist camera_twist(const SplineState& state);

/// Twist of the camera as seen from a moving object, in the camera's frame: before it, the points
/// of the object are static.
///   v = R_c^T (v_c - v_o - w_o x (t_c - t_o)),   w = w_c - R_c^T w_o   (v_o, w_o in the world)
[[nodiscard]] Twist relative_twist(const SplineState& camera, const SplineState& object);

/// Motion [px/s] on the distorted image of the point in the direction `ray` = (x, y, 1) at z depth
/// `depth` [m], 0 = infinitely far, against which the camera moves with `twist`.
[[nodiscard]] Eigen::Vector2d point_motion(const PinholeCamera& camera, const Eigen::Vector3d& ray,
                                           double depth, const Twist& twist);

/// d distort / d pixel (2x2) at a pixel of the ideal image, by central differences: smooth enough
/// for 1e-8.
[[nodiscard]] Eigen::Matrix2d distortion_jacobian(const PinholeCamera& camera,
                                                  const Eigen::Vector2d& pixel);

/// Range of 1 / z over some pixels [1/m]; 0 stands for the background.
struct InverseDepthRange {
  double low = 0;
  double high = 0;
};

/// Upper bounds of the image motion of static points around a direction [px/s].
struct ImageSpeed {
  double fastest = 0;
  double parallax = 0;  ///< of the nearest against the farthest of them
};

/// Bounds for points with inverse depth in `range`, seen within `radius_px` of the direction `ray`
/// = (x, y, 1). The motion field is affine in 1/z, so its norm is largest at an end of the range;
/// away from `ray` it grows no faster than |w| and |v|/z, the terms of its gradient (to first order
/// in the radius).
[[nodiscard]] ImageSpeed image_speed_bound(const PinholeCamera& camera, const Eigen::Vector3d& ray,
                                           double radius_px, const Twist& twist,
                                           const InverseDepthRange& range);

}  // namespace saccade
