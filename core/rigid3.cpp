#include "core/rigid3.h"

#include <cmath>

namespace saccade {
namespace {

// Below this angle [rad] the closed forms lose digits to cancellation and series are exact.
constexpr double kSmallAngle = 1e-2;

/// The coefficients of the closed forms, as functions of t = |w|:
///   a = sin t / t, b = (1 - cos t) / t^2, c = (t - sin t) / t^3.
struct ExpCoefficients {
  double a, b, c;
};

ExpCoefficients exp_coefficients(double t) {
  const double t2 = t * t;
  if (t < kSmallAngle) {
    return {1 - t2 / 6 * (1 - t2 / 20 * (1 - t2 / 42)),
            0.5 * (1 - t2 / 12 * (1 - t2 / 30 * (1 - t2 / 56))),
            (1 - t2 / 20 * (1 - t2 / 42 * (1 - t2 / 72))) / 6};
  }
  const double half_sine = std::sin(t / 2);
  return {std::sin(t) / t, 2 * half_sine * half_sine / t2, (t - std::sin(t)) / (t2 * t)};
}

/// (1 - (t/2) cot(t/2)) / t^2, the coefficient of the inverse left Jacobian.
double inverse_coefficient(double t) {
  const double t2 = t * t;
  if (t < kSmallAngle) return (1 + t2 / 60 * (1 + t2 / 42)) / 12;
  return (1 - 0.5 * t / std::tan(t / 2)) / t2;
}

}  // namespace

Eigen::Matrix3d skew(const Eigen::Vector3d& a) {
  Eigen::Matrix3d m;
  m << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return m;
}

Eigen::Quaterniond so3_exp(const Eigen::Vector3d& rotation_vector) {
  const double half = 0.5 * rotation_vector.norm();
  const double scale = 0.5 * exp_coefficients(half).a;
  Eigen::Quaterniond q;
  q.w() = std::cos(half);
  q.vec() = scale * rotation_vector;
  return q;
}

Eigen::Vector3d so3_log(const Eigen::Quaterniond& rotation) {
  const double sign = rotation.w() < 0 ? -1 : 1;
  const double sine = rotation.vec().norm();
  const double cosine = sign * rotation.w();
  // atan2 keeps all digits at both ends; for tiny angles its ratio to the sine tends to 1 / cosine.
  const double scale = sine < 1e-9 ? 2 / cosine : 2 * std::atan2(sine, cosine) / sine;
  return sign * scale * rotation.vec();
}

Eigen::Matrix3d so3_left_jacobian(const Eigen::Vector3d& rotation_vector) {
  const ExpCoefficients k = exp_coefficients(rotation_vector.norm());
  const Eigen::Matrix3d w = skew(rotation_vector);
  return Eigen::Matrix3d::Identity() + k.b * w + k.c * w * w;
}

Eigen::Matrix3d so3_left_jacobian_inverse(const Eigen::Vector3d& rotation_vector) {
  const Eigen::Matrix3d w = skew(rotation_vector);
  return Eigen::Matrix3d::Identity() - 0.5 * w +
         inverse_coefficient(rotation_vector.norm()) * w * w;
}

Rigid3::Rigid3(const Eigen::Quaterniond& rotation, const Eigen::Vector3d& translation)
    : rotation_(rotation.normalized()), translation_(translation) {}

Rigid3 Rigid3::operator*(const Rigid3& other) const {
  return {rotation_ * other.rotation_, rotation_ * other.translation_ + translation_};
}

Eigen::Vector3d Rigid3::operator*(const Eigen::Vector3d& point) const {
  return rotation_ * point + translation_;
}

Rigid3 Rigid3::inverse() const {
  const Eigen::Quaterniond inverse_rotation = rotation_.conjugate();
  return {inverse_rotation, -(inverse_rotation * translation_)};
}

Rigid3 Rigid3::exp(const Twist& twist) {
  const Eigen::Vector3d w = twist.tail<3>();
  return {so3_exp(w), so3_left_jacobian(w) * twist.head<3>()};
}

Twist Rigid3::log() const {
  Twist twist;
  twist.tail<3>() = so3_log(rotation_);
  twist.head<3>() = so3_left_jacobian_inverse(twist.tail<3>()) * translation_;
  return twist;
}

Matrix6 Rigid3::adjoint() const {
  const Eigen::Matrix3d r = rotation_matrix();
  Matrix6 m;
  m << r, skew(translation_) * r, Eigen::Matrix3d::Zero(), r;
  return m;
}

Eigen::Matrix<double, 3, 6> point_jacobian(const Eigen::Vector3d& point) {
  Eigen::Matrix<double, 3, 6> j;
  j << Eigen::Matrix3d::Identity(), -skew(point);
  return j;
}

Matrix6 se3_left_jacobian(const Twist& twist) {
  const Eigen::Vector3d w = twist.tail<3>();
  const Eigen::Matrix3d p = skew(w);
  const Eigen::Matrix3d r = skew(twist.head<3>());
  const double t = w.norm();
  const double t2 = t * t;
  const double k1 = exp_coefficients(t).c;
  // (t^2 + 2 cos t - 2) / (2 t^4) and (2 t - 3 sin t + t cos t) / (2 t^5), which cancel hopelessly
  // below about 0.1 rad: there their series serve.
  double k2 = (1 - t2 / 30 * (1 - t2 / 56)) / 24;
  double k3 = (1 - t2 / 21 * (1 - t2 / 48)) / 120;
  if (t > 0.2) {
    k2 = (t2 + 2 * std::cos(t) - 2) / (2 * t2 * t2);
    k3 = (2 * t - 3 * std::sin(t) + t * std::cos(t)) / (2 * t2 * t2 * t);
  }
  const Eigen::Matrix3d q = 0.5 * r + k1 * (p * r + r * p + p * r * p) +
                            k2 * (p * p * r + r * p * p - 3 * p * r * p) +
                            k3 * (p * r * p * p + p * p * r * p);
  const Eigen::Matrix3d j = so3_left_jacobian(w);
  Matrix6 m;
  m << j, q, Eigen::Matrix3d::Zero(), j;
  return m;
}

double angle_between(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b) {
  return so3_log(a.conjugate() * b).norm();
}

Rigid3 interpolate(const Rigid3& a, const Rigid3& b, double fraction) {
  return {a.rotation().slerp(fraction, b.rotation()),
          (1 - fraction) * a.translation() + fraction * b.translation()};
}

}  // namespace saccade
