#include "estimator/imu/preintegration.h"

#include <algorithm>
#include <cstddef>

#include "core/check.h"
#include "core/rigid3.h"
#include "core/time_search.h"

namespace saccade {
namespace {

constexpr double kMaxGap_s = 0.1;

using Vector6 = Eigen::Matrix<double, 6, 1>;

Vector6 difference(const ImuBias& a, const ImuBias& b) {
  return (Vector6() << a.gyro - b.gyro, a.accel - b.accel).finished();
}

/// Linear interpolation between two samples.
ImuSample interpolated(const ImuSample& a, const ImuSample& b, double t_s) {
  const double fraction = (t_s - seconds_from_ns(a.t_ns)) / seconds_from_ns(b.t_ns - a.t_ns);
  ImuSample sample;
  sample.t_ns = ns_from_seconds(t_s);
  sample.specific_force = (1 - fraction) * a.specific_force + fraction * b.specific_force;
  sample.angular_velocity = (1 - fraction) * a.angular_velocity + fraction * b.angular_velocity;
  return sample;
}

/// Integrates over `dt_s` of constant w and f, less their biases.
void integrate(Preintegration& sum, const Eigen::Vector3d& w, const Eigen::Vector3d& f, double dt_s,
               const ImuCalibration& noise) {
  const Eigen::Quaterniond half = sum.rotation * so3_exp(0.5 * dt_s * w);
  const Eigen::Matrix3d q = half.toRotationMatrix();
  const Eigen::Vector3d dv = dt_s * (q * f);
  // A and B of Forster et al.: Jacobians of (dR, dV, dP) after the step with respect to those
  // before it, and to w and f; here of the midpoint rule.
  Preintegration::Matrix9 a = Preintegration::Matrix9::Identity();
  Eigen::Matrix<double, 9, 6> b = Eigen::Matrix<double, 9, 6>::Zero();
  const Eigen::Matrix3d back = so3_exp(-dt_s * w).toRotationMatrix();
  const Eigen::Matrix3d half_back = so3_exp(-0.5 * dt_s * w).toRotationMatrix();
  const Eigen::Matrix3d by_tilt = -dt_s * q * skew(f);
  a.block<3, 3>(0, 0) = back;
  a.block<3, 3>(3, 0) = by_tilt * half_back;
  a.block<3, 3>(6, 0) = 0.5 * dt_s * by_tilt * half_back;
  a.block<3, 3>(6, 3) = dt_s * Eigen::Matrix3d::Identity();
  b.block<3, 3>(0, 0) = dt_s * so3_left_jacobian(-dt_s * w);
  b.block<3, 3>(3, 0) = 0.5 * dt_s * by_tilt * so3_left_jacobian(-0.5 * dt_s * w);
  b.block<3, 3>(6, 0) = 0.5 * dt_s * b.block<3, 3>(3, 0);
  b.block<3, 3>(3, 3) = dt_s * q;
  b.block<3, 3>(6, 3) = 0.5 * dt_s * dt_s * q;
  Vector6 variance;
  variance << Eigen::Vector3d::Constant(noise.gyroscope.density * noise.gyroscope.density / dt_s),
      Eigen::Vector3d::Constant(noise.accelerometer.density * noise.accelerometer.density / dt_s);
  sum.covariance = a * sum.covariance * a.transpose() + b * variance.asDiagonal() * b.transpose();
  sum.bias_jacobian = a * sum.bias_jacobian - b;
  sum.position += dt_s * sum.velocity + 0.5 * dt_s * dv;
  sum.velocity += dv;
  sum.rotation = (sum.rotation * so3_exp(dt_s * w)).normalized();
  sum.duration_s += dt_s;
}

}  // namespace

Eigen::Quaterniond Preintegration::rotation_with(const ImuBias& other) const {
  return rotation * so3_exp(bias_jacobian.topRows<3>() * difference(other, bias));
}

Eigen::Vector3d Preintegration::velocity_with(const ImuBias& other) const {
  return velocity + bias_jacobian.middleRows<3>(3) * difference(other, bias);
}

Eigen::Vector3d Preintegration::position_with(const ImuBias& other) const {
  return position + bias_jacobian.bottomRows<3>() * difference(other, bias);
}

std::optional<Preintegration> preintegrate(std::span<const ImuSample> samples, double from_s,
                                           double to_s, const ImuBias& bias,
                                           const ImuCalibration& noise) {
  SACCADE_CHECK(to_s > from_s);
  const std::size_t first = count_until(
      samples, from_s, [](const ImuSample& sample) { return seconds_from_ns(sample.t_ns); });
  if (first == 0 || first == samples.size()) return std::nullopt;
  Preintegration sum;
  sum.bias = bias;
  sum.first_rate =
      interpolated(samples[first - 1], samples[first], from_s).angular_velocity - bias.gyro;
  double now_s = from_s;
  for (std::size_t k = first; now_s < to_s; ++k) {
    if (k == samples.size()) return std::nullopt;
    const ImuSample &before = samples[k - 1], &next = samples[k];
    if (seconds_from_ns(next.t_ns - before.t_ns) > kMaxGap_s) return std::nullopt;
    const double end_s = std::min(to_s, seconds_from_ns(next.t_ns));
    // Linear in between: the mean is the value in the middle.
    const ImuSample middle = interpolated(before, next, 0.5 * (now_s + end_s));
    if (end_s > now_s)
      integrate(sum, middle.angular_velocity - bias.gyro, middle.specific_force - bias.accel,
                end_s - now_s, noise);
    sum.last_rate = interpolated(before, next, end_s).angular_velocity - bias.gyro;
    now_s = end_s;
  }
  return sum;
}

}  // namespace saccade
