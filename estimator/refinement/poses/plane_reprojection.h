#pragma once

#include <cmath>

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
[[nodiscard]] inline PlaneReprojection reproject_on_plane(const PinholeCamera& camera,
                                                          const Rigid3& view_from_camera,
                                                          const Eigen::Vector3d& ray,
                                                          const ViewPlane& plane) {
  PlaneReprojection reprojection;
  const Eigen::Matrix3d rotation = view_from_camera.rotation_matrix();
  const Eigen::Vector3d& origin = view_from_camera.translation();
  const Eigen::Vector3d direction = rotation * ray;
  const double approach = plane.dot(direction);
  const double distance = (1 - plane.dot(origin)) / approach;
  const Eigen::Vector3d point = origin + distance * direction;
  if (!(std::isfinite(distance) && distance > 0 && point.z() > 0)) return reprojection;
  reprojection.is_valid = true;
  reprojection.pixel = camera.project(point);
  const Eigen::Matrix3d along_plane =
      Eigen::Matrix3d::Identity() - direction * plane.transpose() / approach;
  const Eigen::Matrix<double, 2, 3> by_shift = camera.project_jacobian(point) * along_plane;
  reprojection.by_motion << by_shift, -distance * by_shift * rotation * skew(ray);
  return reprojection;
}

}  // namespace saccade
