#pragma once

#include <Eigen/Core>

#include "core/camera.h"
#include "core/rigid3.h"

namespace saccade {

/// A plane of a view, a . X = 1 for its points X in the view's camera [m]: 1 / z = a . K^-1 u,
/// linear in the image.
using ViewPlane = Eigen::Vector3d;

/// Reprojection into a view of the point of a plane that another camera's ray meets.
struct PlaneReprojection {
  Eigen::Vector2d pixel;                  ///< in the view
  Eigen::Matrix<double, 2, 6> by_motion;  ///< by the camera's motion, see reproject_on_plane()
  bool is_valid = false;                  ///< false: the ray does not meet the plane before both
};

/// The ray q = K^-1 u of a camera at (R, o) = view_from_camera meets the plane at
///   X = o + s R q,   s = (1 - a . o) / (a . R q),
/// which the view sees at pi(X). With dX = (I - R q a^T / (a . R q)) (do + s d(R q)) the derivative
/// is exact for the plane: by (e, w) with o -> o + e, in the view's axes, and R -> R Exp(w).
[[nodiscard]] PlaneReprojection reproject_on_plane(const PinholeCamera& camera,
                                                   const Rigid3& view_from_camera,
                                                   const Eigen::Vector3d& ray,
                                                   const ViewPlane& plane);

}  // namespace saccade
