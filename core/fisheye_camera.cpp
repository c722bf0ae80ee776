#include "core/fisheye_camera.h"

#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.h"

namespace saccade {
namespace {

/// d of the angle theta.
double distorted_angle(double theta, const std::array<double, 4>& k) {
  const double t2 = theta * theta;
  return theta * (1 + t2 * (k[0] + t2 * (k[1] + t2 * (k[2] + t2 * k[3]))));
}

/// The largest d on the sensor: at one of its corners.
double largest_distorted_angle(const FisheyeCamera& camera) {
  const double x = std::max(camera.cx, camera.width - 1 - camera.cx) / camera.fx;
  const double y = std::max(camera.cy, camera.height - 1 - camera.cy) / camera.fy;
  return std::hypot(x, y);
}

constexpr double kWidestAngle = 80 * std::numbers::pi / 180;
constexpr int kRings = 1000;

/// Angles from the axis to the corner, in even steps.
double widest_angle(const FisheyeCamera& camera, const std::string& place) {
  const double most = largest_distorted_angle(camera);
  for (int i = 1; i <= kRings; ++i) {
    const double theta = kWidestAngle * i / kRings;
    if (distorted_angle(theta, camera.k) >= most) return theta;
  }
  throw InputError(place, "the lens sees 80 degrees off its axis: no pinhole camera stands for it");
}

}  // namespace

Eigen::Vector2d FisheyeCamera::project(const Eigen::Vector2d& ray) const {
  const double r = ray.norm();
  const double scale = r > 0 ? distorted_angle(std::atan(r), k) / r : 1;
  return {fx * scale * ray.x() + cx, fy * scale * ray.y() + cy};
}

FisheyeFit fit_pinhole(const FisheyeCamera& camera, const std::string& place) {
  const double widest = widest_angle(camera, place);
  Eigen::Matrix<double, kRings, 4> powers;
  Eigen::Matrix<double, kRings, 1> wanted, weight;
  for (int i = 0; i < kRings; ++i) {
    const double theta = widest * (i + 1) / kRings;
    const double r = std::tan(theta);
    powers.row(i) << r, std::pow(r, 3), std::pow(r, 5), std::pow(r, 7);
    wanted[i] = distorted_angle(theta, camera.k);
    weight[i] = std::sqrt(wanted[i]);
  }
  const Eigen::Vector4d c =
      (weight.asDiagonal() * powers).colPivHouseholderQr().solve(weight.cwiseProduct(wanted));
  FisheyeFit fit;
  fit.camera = {camera.width,
                camera.height,
                c[0] * camera.fx,
                c[0] * camera.fy,
                camera.cx,
                camera.cy,
                {c[1] / c[0], c[2] / c[0], 0, 0, c[3] / c[0]}};
  fit.residual_px = std::max(camera.fx, camera.fy) * (powers * c - wanted).cwiseAbs().maxCoeff();
  return fit;
}

}  // namespace saccade
