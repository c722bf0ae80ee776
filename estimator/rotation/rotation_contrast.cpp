#include "estimator/rotation/rotation_contrast.h"

#include <algorithm>
#include <cmath>

namespace saccade {

RotationContrast::RotationContrast(const PinholeCamera& camera, double blur_px,
                                   const BurstLimits& bursts, std::size_t max_events)
    : camera_(camera.undistorted()), filter_(camera, bursts, max_events), image_(camera, blur_px) {}

void RotationContrast::load(std::span<const Event> events) {
  rays_ = filter_.rays_of(events);
  x_.resize(rays_.x.size());
  y_.resize(rays_.x.size());
  set_times();
}

void RotationContrast::set_times() {
  const auto count = static_cast<double>(rays_.t.size());
  Eigen::Vector4d moments = Eigen::Vector4d::Zero();  // of t, t^2, t^3, t^4
  for (const float time : rays_.t) {
    const auto t = static_cast<double>(time);
    moments += Eigen::Vector4d(t, t * t, t * t * t, t * t * t * t) / count;
  }
  const double variance = moments[1] - moments[0] * moments[0];
  const double slope = variance > 0 ? (moments[2] - moments[1] * moments[0]) / variance : 0;
  reference_after_middle_s_ = slope / 2;
  const double offset = (moments[1] - slope * moments[0]) / 2;
  s_.clear();
  double squares = 0;
  for (const float time : rays_.t) {
    const auto t = static_cast<double>(time);
    const double s = t * t / 2 - reference_after_middle_s_ * t - offset;  // (d)
    s_.push_back(static_cast<float>(s));
    squares += s * s;
  }
  px_per_rate_ = camera_.fx * std::sqrt(std::max(variance, 0.0));
  px_per_acceleration_ = camera_.fx * std::sqrt(squares / count);
}

void RotationContrast::warp(const Parameters& parameters) {
  const auto fx = static_cast<float>(camera_.fx), fy = static_cast<float>(camera_.fy);
  const auto cx = static_cast<float>(camera_.cx + image_.margin());
  const auto cy = static_cast<float>(camera_.cy + image_.margin());
  const Eigen::Matrix<float, 6, 1> p = parameters.cast<float>();
  for (std::size_t i = 0; i < rays_.x.size(); ++i) {
    const float a = rays_.x[i], b = rays_.y[i], t = rays_.t[i], s = s_[i];
    // (a), with exp() to second order: within 2e-4 px at 0.1 rad.
    const float tx = t * p[0] + s * p[3], ty = t * p[1] + s * p[4], tz = t * p[2] + s * p[5];
    const float cross_x = ty - tz * b, cross_y = tz * a - tx, cross_z = tx * b - ty * a;
    const float x = a + cross_x + 0.5F * (ty * cross_z - tz * cross_y);
    const float y = b + cross_y + 0.5F * (tz * cross_x - tx * cross_z);
    const float z = 1 + cross_z + 0.5F * (tx * cross_y - ty * cross_x);
    const float u = fx * x / z + cx, v = fy * y / z + cy;
    x_[i] = image_.contains(u, v) ? u : -1;
    y_[i] = v;
  }
}

auto RotationContrast::evaluate(const Parameters& parameters) -> Value {
  warp(parameters);
  image_.draw(x_, y_);
  image_.smooth();
  const double norm = 1 / (static_cast<double>(x_.size()) * static_cast<double>(x_.size()));
  Value value;
  value.contrast = norm * image_.sum_of_squares();  // (b)
  image_.smooth();
  const auto fx = static_cast<float>(camera_.fx), fy = static_cast<float>(camera_.fy);
  const auto cx = static_cast<float>(camera_.cx + image_.margin());
  const auto cy = static_cast<float>(camera_.cy + image_.margin());
  Eigen::Matrix<float, 6, 1> sum = Eigen::Matrix<float, 6, 1>::Zero();
  Parameters total = Parameters::Zero();
  constexpr std::size_t kBlock = 256;  // summed in single precision
  for (std::size_t i = 0; i < x_.size(); ++i) {
    if (x_[i] >= 0) {
      const auto gradient = sample_with_gradient(image_.pixels(), x_[i], y_[i]);
      const float gx = fx * gradient.dx, gy = fy * gradient.dy;
      // dx_k/dp to first order in the rotation: the motion field of a rotation at the warped point,
      // [-a b, 1 + a^2, -b; -1 - b^2, a b, a] with the sign of x' = x + angle cross x.
      const float a = (x_[i] - cx) / fx, b = (y_[i] - cy) / fy;
      const Eigen::Vector3f by_angle(-a * b * gx - (1 + b * b) * gy, (1 + a * a) * gx + a * b * gy,
                                     a * gy - b * gx);
      sum.head<3>() += rays_.t[i] * by_angle;
      sum.tail<3>() += s_[i] * by_angle;
    }
    if (i % kBlock == kBlock - 1 || i + 1 == x_.size()) {
      total += sum.cast<double>();
      sum.setZero();
    }
  }
  value.gradient = 2 * norm * total;  // (c)
  return value;
}

}  // namespace saccade
