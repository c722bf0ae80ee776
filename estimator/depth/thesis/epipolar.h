#pragma once

#include <Eigen/SVD>

#include <Eigen/Core>

#include "core/camera.h"

namespace saccade {

/// Projections of the points of one ray of the reference view into a derotated frame. All frames have
/// the reference's orientation, so that P1 = [I | 0] and P2 = [I | -c] with c the frame's centre in
/// the reference view (thesis 5.3, 5.6 with R taken out), and over inverse depth rho
///   u(rho) = pi(ray - rho c),   du/drho = -pi'(ray - rho c) c,
/// a straight line in the image: the epipolar line.
class EpipolarLine {
 public:
  /// `ray` = (x, y, 1) of the reference view; `centre` [m].
  EpipolarLine(const PinholeCamera& camera, const Eigen::Vector3d& ray,
               const Eigen::Vector3d& centre)
      : camera_(camera), ray_(ray), centre_(centre) {}

  /// True where the point lies in front of the frame's camera.
  [[nodiscard]] bool is_in_front(double inverse_depth) const {
    return ray_.z() - inverse_depth * centre_.z() > kMinDepthRatio;
  }
  /// u(rho) [px]; is_in_front(rho) holds.
  [[nodiscard]] Eigen::Vector2d pixel(double inverse_depth) const {
    return camera_.project(ray_ - inverse_depth * centre_);
  }
  /// du/drho [px m].
  [[nodiscard]] Eigen::Vector2d derivative(double inverse_depth) const {
    return -camera_.project_jacobian(ray_ - inverse_depth * centre_) * centre_;
  }

 private:
  /// Depth in the frame over depth in the reference view; below it pi' is too large to linearise.
  static constexpr double kMinDepthRatio = 0.05;

  PinholeCamera camera_;
  Eigen::Vector3d ray_;
  Eigen::Vector3d centre_;
};

/// Inverse depth in the first view of the point that both rays see (thesis 5.5-5.13): the DLT's
/// A X = 0 from P1 = [I | 0] and P2 = [I | -centre], X the right singular vector of the least
/// singular value, 1 / z = X_4 / X_3. May be negative or infinite where the rays diverge.
[[nodiscard]] inline double triangulate(const Eigen::Vector3d& first_ray,
                                        const Eigen::Vector3d& second_ray,
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
