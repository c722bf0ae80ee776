#include "core/camera.h"

#include <cmath>

#include <Eigen/LU>

#include "core/error.h"

namespace saccade {
namespace {

/// Brown's model on normalised coordinates (Brown, 1966; OpenCV's calib3d); `jacobian`: d result /
/// dp.
Eigen::Vector2d distort_normalised(const std::array<double, 5>& k, const Eigen::Vector2d& p,
                                   Eigen::Matrix2d& jacobian) {
  const auto [k1, k2, p1, p2, k3] = k;
  const double x = p.x();
  const double y = p.y();
  const double r2 = x * x + y * y;
  const double radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3));
  const double slope = 2 * (k1 + r2 * (2 * k2 + 3 * r2 * k3));  // d radial / d(r2), doubled
  jacobian << radial + x * x * slope + 2 * p1 * y + 6 * p2 * x,
      x * y * slope + 2 * p1 * x + 2 * p2 * y, x * y * slope + 2 * p1 * x + 2 * p2 * y,
      radial + y * y * slope + 6 * p1 * y + 2 * p2 * x;
  return {x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x),
          y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y};
}

}  // namespace

Eigen::Matrix3d PinholeCamera::matrix() const {
  Eigen::Matrix3d k;
  k << fx, 0, cx, 0, fy, cy, 0, 0, 1;
  return k;
}

Eigen::Matrix<double, 2, 3> PinholeCamera::project_jacobian(const Eigen::Vector3d& point) const {
  const double iz = 1 / point.z();
  Eigen::Matrix<double, 2, 3> j;
  j << fx * iz, 0, -fx * point.x() * iz * iz, 0, fy * iz, -fy * point.y() * iz * iz;
  return j;
}

Eigen::Vector2d PinholeCamera::distort(const Eigen::Vector2d& pixel) const {
  if (!is_distorted()) return pixel;
  Eigen::Matrix2d jacobian;
  const Eigen::Vector2d d = distort_normalised(distortion, ray(pixel).head<2>(), jacobian);
  return {fx * d.x() + cx, fy * d.y() + cy};
}

Eigen::Vector2d PinholeCamera::undistort(const Eigen::Vector2d& pixel) const {
  if (!is_distorted()) return pixel;
  constexpr int kMaxIterations = 20;
  const Eigen::Vector2d target = ray(pixel).head<2>();
  const double tolerance = 1e-9 / std::max(fx, fy);
  Eigen::Vector2d estimate = target;
  for (int i = 0; i < kMaxIterations; ++i) {
    Eigen::Matrix2d jacobian;
    const Eigen::Vector2d residual = target - distort_normalised(distortion, estimate, jacobian);
    if (residual.norm() < tolerance || std::abs(jacobian.determinant()) < 1e-6) break;
    estimate += jacobian.inverse() * residual;
  }
  return {fx * estimate.x() + cx, fy * estimate.y() + cy};
}

PinholeCamera PinholeCamera::undistorted() const {
  PinholeCamera camera = *this;
  camera.distortion = {};
  return camera;
}

void PinholeCamera::check(const std::string& location) const {
  // One row or column shows no motion across it, and has no gradient there.
  if (width < 2 || height < 2)
    throw InputError(location, "camera has no area: " + std::to_string(width) + " x " +
                                   std::to_string(height) +
                                   " px; both sides must have two pixels or more");
  if (width > 65535 || height > 65535)
    throw InputError(location,
                     "camera is wider or higher than 65535 px, the limit of event coordinates");
  if (!(fx > 0) || !(fy > 0) || !std::isfinite(fx) || !std::isfinite(fy))
    throw InputError(location, "focal lengths fx and fy must be positive and finite");
  bool finite = std::isfinite(cx) && std::isfinite(cy);
  for (const double k : distortion) finite = finite && std::isfinite(k);
  if (!finite) throw InputError(location, "principal point and distortion must be finite");
}

Eigen::Matrix<double, 2, 6> interaction_matrix(const PinholeCamera& camera,
                                               const Eigen::Vector3d& ray, double depth) {
  const double x = ray.x();
  const double y = ray.y();
  const double iz = 1 / depth;
  Eigen::Matrix<double, 2, 6> j;
  j << iz, 0, -x * iz, -x * y, 1 + x * x, -y,  //
      0, iz, -y * iz, -(1 + y * y), x * y, x;
  j.row(0) *= camera.fx;
  j.row(1) *= camera.fy;
  return j;
}

UndistortionTable::UndistortionTable(const PinholeCamera& camera) : width_(camera.width) {
  pixels_.reserve(static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height));
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x)
      pixels_.emplace_back(camera.undistort({x, y}).cast<float>());
}

}  // namespace saccade
