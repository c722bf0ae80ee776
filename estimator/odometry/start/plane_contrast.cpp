#include "estimator/odometry/start/plane_contrast.h"

#include <cmath>

namespace saccade {
namespace {

/// A plane that is seen under a flatter angle, or from behind, is not drawn: m . R q and 1 - m . o.
constexpr float kLeastInverseDepth = 0.1F;

}  // namespace

PlaneContrast::PlaneContrast(const PinholeCamera& camera, double blur_px, const BurstLimits& bursts,
                             std::size_t max_events)
    : camera_(camera.undistorted()), filter_(camera, bursts, max_events), image_(camera, blur_px) {}

void PlaneContrast::load(std::span<const Event> events) {
  rays_ = filter_.rays_of(events);
  double squares = 0;
  for (const float t : rays_.t) squares += static_cast<double>(t) * static_cast<double>(t);
  px_per_rate_ = camera_.fx * std::sqrt(squares / static_cast<double>(rays_.t.size()));
  for (auto* values : {&x_, &y_}) values->resize(rays_.t.size());
  for (auto* points : {&rotated_, &in_middle_}) points->resize(rays_.t.size());
}

auto PlaneContrast::parameters_of(const PlaneMotion& motion) -> Parameters {
  Parameters parameters;
  parameters << motion.velocity, motion.rate, motion.slope;
  return parameters;
}

PlaneMotion PlaneContrast::motion_of(const Parameters& parameters) {
  return {parameters.head<3>(), parameters.segment<3>(3), parameters.tail<2>()};
}

void PlaneContrast::warp(const PlaneMotion& motion) {
  const auto fx = static_cast<float>(camera_.fx), fy = static_cast<float>(camera_.fy);
  const auto cx = static_cast<float>(camera_.cx + image_.margin());
  const auto cy = static_cast<float>(camera_.cy + image_.margin());
  const Eigen::Vector3f velocity = motion.velocity.cast<float>();
  const Eigen::Vector3f rate = motion.rate.cast<float>();
  const Eigen::Vector3f plane = motion.plane().cast<float>();
  for (std::size_t i = 0; i < x_.size(); ++i) {
    const Eigen::Vector3f ray(rays_.x[i], rays_.y[i], 1), angle = rays_.t[i] * rate;
    // exp() to second order: within 2e-4 px at 0.1 rad.
    const Eigen::Vector3f cross = angle.cross(ray);
    const Eigen::Vector3f rotated = ray + cross + 0.5F * angle.cross(cross);
    const Eigen::Vector3f origin = rays_.t[i] * velocity;
    const float towards = plane.dot(rotated), distance = 1 - plane.dot(origin);
    x_[i] = -1;
    if (!(towards > kLeastInverseDepth) || !(distance > kLeastInverseDepth)) continue;
    const Eigen::Vector3f point = origin + distance / towards * rotated;
    if (!(point.z() > 0)) continue;
    const float u = fx * point.x() / point.z() + cx, v = fy * point.y() / point.z() + cy;
    if (!image_.contains(u, v)) continue;
    x_[i] = u;
    y_[i] = v;
    rotated_[i] = rotated;
    in_middle_[i] = point;
  }
}

auto PlaneContrast::evaluate(const Parameters& parameters) -> Value {
  const PlaneMotion motion = motion_of(parameters);
  warp(motion);
  image_.draw(x_, y_);
  image_.smooth();
  const double norm = 1 / (static_cast<double>(x_.size()) * static_cast<double>(x_.size()));
  Value value;
  value.contrast = norm * image_.sum_of_squares();
  image_.smooth();
  const auto fx = static_cast<float>(camera_.fx), fy = static_cast<float>(camera_.fy);
  const Eigen::Vector3f plane = motion.plane().cast<float>();
  const Eigen::Vector3f rate = motion.rate.cast<float>();
  const Eigen::Vector3f velocity = motion.velocity.cast<float>();
  for (std::size_t i = 0; i < x_.size(); ++i) {
    if (x_[i] < 0) continue;
    const auto slope = sample_with_gradient(image_.pixels(), x_[i], y_[i]);
    const Eigen::Vector3f &point = in_middle_[i], &rotated = rotated_[i];
    const float gx = fx * slope.dx / point.z(), gy = fy * slope.dy / point.z();
    const Eigen::Vector3f by_point(gx, gy, -(gx * point.x() + gy * point.y()) / point.z());
    const float t = rays_.t[i], towards = plane.dot(rotated);
    const float along = rotated.dot(by_point) / towards;
    const Eigen::Vector3f on_plane = by_point - along * plane;
    const float reach = (1 - t * plane.dot(velocity)) / towards;
    const Eigen::Vector3f by_rotation = reach * rotated.cross(on_plane);
    value.gradient.head<3>() += (t * on_plane).cast<double>();
    value.gradient.segment<3>(3) +=
        (t * (by_rotation - 0.5F * t * rate.cross(by_rotation))).cast<double>();
    value.gradient.tail<2>() -= (along * point.head<2>()).cast<double>();
  }
  value.gradient *= 2 * norm;
  return value;
}

}  // namespace saccade
