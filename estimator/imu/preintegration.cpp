#include "estimator/imu/preintegration.h"

#include <algorithm>

#include "core/check.h"
#include "core/rigid3.h"

namespace saccade {
namespace {

constexpr double kLongestGap_s = 0.1;

using Vector6 = Eigen::Matrix<double, 6, 1>;

Vector6 difference(const ImuBias& a, const ImuBias& b) {
  return (Vector6() << a.gyro - b.gyro, a.accel - b.accel).finished();
}

/// The reading at an instant between two.
ImuSample between(const ImuSample& a, const ImuSample& b, double t_s) {
  const double share = (t_s - seconds_from_ns(a.t_ns)) / seconds_from_ns(b.t_ns - a.t_ns);
  ImuSample sample;
  sample.t_ns = ns_from_seconds(t_s);
  sample.specific_force = (1 - share) * a.specific_force + share * b.specific_force;
  sample.angular_velocity = (1 - share) * a.angular_velocity + share * b.angular_velocity;
  return sample;
}

/// Goes on by `dt_s` at even readings w, f, less their biases.
void step(Preintegration& sum, const Eigen::Vector3d& w, const Eigen::Vector3d& f, double dt_s,
          const ImuCalibration& noise) {
  const Eigen::Quaterniond half = sum.turn * so3_exp(0.5 * dt_s * w);
  const Eigen::Matrix3d q = half.toRotationMatrix();
  const Eigen::Vector3d gain = dt_s * (q * f);
  // (turn, V, P) after the step by those before it, and by w and f.
  Preintegration::Matrix9 by_before = Preintegration::Matrix9::Identity();
  Eigen::Matrix<double, 9, 6> by_reading = Eigen::Matrix<double, 9, 6>::Zero();
  const Eigen::Matrix3d back = so3_exp(-dt_s * w).toRotationMatrix();
  const Eigen::Matrix3d half_back = so3_exp(-0.5 * dt_s * w).toRotationMatrix();
  const Eigen::Matrix3d by_tilt = -dt_s * q * skew(f);
  by_before.block<3, 3>(0, 0) = back;
  by_before.block<3, 3>(3, 0) = by_tilt * half_back;
  by_before.block<3, 3>(6, 0) = 0.5 * dt_s * by_tilt * half_back;
  by_before.block<3, 3>(6, 3) = dt_s * Eigen::Matrix3d::Identity();
  by_reading.block<3, 3>(0, 0) = dt_s * so3_left_jacobian(-dt_s * w);
  by_reading.block<3, 3>(3, 0) = 0.5 * dt_s * by_tilt * so3_left_jacobian(-0.5 * dt_s * w);
  by_reading.block<3, 3>(6, 0) = 0.5 * dt_s * by_reading.block<3, 3>(3, 0);
  by_reading.block<3, 3>(3, 3) = dt_s * q;
  by_reading.block<3, 3>(6, 3) = 0.5 * dt_s * dt_s * q;
  Vector6 variance;
  variance << Eigen::Vector3d::Constant(noise.gyroscope.density * noise.gyroscope.density / dt_s),
      Eigen::Vector3d::Constant(noise.accelerometer.density * noise.accelerometer.density / dt_s);
  sum.covariance = by_before * sum.covariance * by_before.transpose() +
                   by_reading * variance.asDiagonal() * by_reading.transpose();
  sum.by_bias = by_before * sum.by_bias - by_reading;
  sum.position += dt_s * sum.velocity + 0.5 * dt_s * gain;
  sum.velocity += gain;
  sum.turn = (sum.turn * so3_exp(dt_s * w)).normalized();
  sum.duration_s += dt_s;
}

}  // namespace

Eigen::Quaterniond Preintegration::turn_with(const ImuBias& other) const {
  return turn * so3_exp(by_bias.topRows<3>() * difference(other, bias));
}

Eigen::Vector3d Preintegration::velocity_with(const ImuBias& other) const {
  return velocity + by_bias.middleRows<3>(3) * difference(other, bias);
}

Eigen::Vector3d Preintegration::position_with(const ImuBias& other) const {
  return position + by_bias.bottomRows<3>() * difference(other, bias);
}

std::optional<Preintegration> preintegrate(std::span<const ImuSample> readings, double from_s,
                                           double to_s, const ImuBias& bias,
                                           const ImuCalibration& noise) {
  SACCADE_CHECK(to_s > from_s);
  const auto after = std::partition_point(readings.begin(), readings.end(), [&](const auto& s) {
    return seconds_from_ns(s.t_ns) <= from_s;
  });
  if (after == readings.begin() || after == readings.end()) return std::nullopt;
  Preintegration sum;
  sum.bias = bias;
  sum.first_rate = between(*(after - 1), *after, from_s).angular_velocity - bias.gyro;
  double now_s = from_s;
  for (auto next = after; now_s < to_s; ++next) {
    if (next == readings.end()) return std::nullopt;
    const ImuSample& before = *(next - 1);
    if (seconds_from_ns(next->t_ns - before.t_ns) > kLongestGap_s) return std::nullopt;
    const double end_s = std::min(to_s, seconds_from_ns(next->t_ns));
    // Readings are linear in between: their mean is that in the middle.
    const ImuSample middle = between(before, *next, 0.5 * (now_s + end_s));
    if (end_s > now_s)
      step(sum, middle.angular_velocity - bias.gyro, middle.specific_force - bias.accel,
           end_s - now_s, noise);
    sum.last_rate = between(before, *next, end_s).angular_velocity - bias.gyro;
    now_s = end_s;
  }
  return sum;
}

}  // namespace saccade
