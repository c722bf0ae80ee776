#include "estimator/refinement/poses/plane_reprojection.h"

#include <cmath>

namespace saccade {

PlaneReprojection reproject_on_plane(const PinholeCamera& camera, const Rigid3& view_from_camera,
                                     const Eigen::Vector3d& ray, const ViewPlane& plane) {
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
