#include "estimator/depth/thesis/epipolar.h"

#include <Eigen/SVD>

namespace saccade {

Eigen::Vector2d EpipolarLine::pixel(double inverse_depth) const {
  return camera_.project(ray_ - inverse_depth * centre_);
}

Eigen::Vector2d EpipolarLine::derivative(double inverse_depth) const {
  return -camera_.project_jacobian(ray_ - inverse_depth * centre_) * centre_;
}

double triangulate(const Eigen::Vector3d& first_ray, const Eigen::Vector3d& second_ray,
                   const Eigen::Vector3d& centre) {
  Eigen::Matrix<double, 3, 4> first = Eigen::Matrix<double, 3, 4>::Identity();
  Eigen::Matrix<double, 3, 4> second = first;
  second.col(3) = -centre;
  Eigen::Matrix4d a;  // A X = 0 of (5.12)
  a.row(0) = first_ray.x() * first.row(2) - first_ray.z() * first.row(0);
  a.row(1) = first_ray.y() * first.row(2) - first_ray.z() * first.row(1);
  a.row(2) = second_ray.x() * second.row(2) - second_ray.z() * second.row(0);
  a.row(3) = second_ray.y() * second.row(2) - second_ray.z() * second.row(1);
  const Eigen::JacobiSVD<Eigen::Matrix4d> svd(a, Eigen::ComputeFullV);
  const Eigen::Vector4d point = svd.matrixV().col(3);
  return point.w() / point.z();  // 1 / z of (5.13)
}

}  // namespace saccade
