#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace saccade {

/// A twist (v, w) in se(3): translation first, then rotation (thesis 4.13).
using Twist = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// The cross-product matrix: skew(a) b = a x b.
[[nodiscard]] Eigen::Matrix3d skew(const Eigen::Vector3d& a);

/// SO(3) exponential of a rotation vector [rad] (Rodrigues); exact to machine precision also near
/// zero.
[[nodiscard]] Eigen::Quaterniond so3_exp(const Eigen::Vector3d& rotation_vector);

/// SO(3) logarithm, |result| <= pi. Sign of the quaternion does not matter.
[[nodiscard]] Eigen::Vector3d so3_log(const Eigen::Quaterniond& rotation);

/// Left Jacobian of SO(3): exp((w + dw)^) = exp((J dw)^) exp(w^) to first order.
[[nodiscard]] Eigen::Matrix3d so3_left_jacobian(const Eigen::Vector3d& rotation_vector);
[[nodiscard]] Eigen::Matrix3d so3_left_jacobian_inverse(const Eigen::Vector3d& rotation_vector);

/// A rigid transformation p_a = R p_b + t. Objects are named a_from_b (`world_from_camera`), so
/// that neighbouring names cancel in products:
///   world_from_camera * camera_from_imu = world_from_imu.
class Rigid3 {
 public:
  Rigid3() = default;
  /// `rotation` is normalised.
  Rigid3(const Eigen::Quaterniond& rotation, const Eigen::Vector3d& translation);

  [[nodiscard]] const Eigen::Quaterniond& rotation() const { return rotation_; }
  [[nodiscard]] const Eigen::Vector3d& translation() const { return translation_; }
  [[nodiscard]] Eigen::Matrix3d rotation_matrix() const { return rotation_.toRotationMatrix(); }

  [[nodiscard]] Rigid3 operator*(const Rigid3& other) const;
  [[nodiscard]] Eigen::Vector3d operator*(const Eigen::Vector3d& point) const;
  [[nodiscard]] Rigid3 inverse() const;

  /// exp(xi^) (thesis 4.14): the translation is V(w) v with V the left Jacobian of SO(3).
  [[nodiscard]] static Rigid3 exp(const Twist& twist);
  /// The twist with exp(log()) = *this, rotation part at most pi.
  [[nodiscard]] Twist log() const;

  /// Adjoint: T exp(xi^) T^-1 = exp((Ad xi)^).
  [[nodiscard]] Matrix6 adjoint() const;

 private:
  Eigen::Quaterniond rotation_ = Eigen::Quaterniond::Identity();
  Eigen::Vector3d translation_ = Eigen::Vector3d::Zero();
};

/// d(T exp(xi^) p)/d xi at xi = 0, rotated into the frame of p: [I, -skew(p)] (3x6).
[[nodiscard]] Eigen::Matrix<double, 3, 6> point_jacobian(const Eigen::Vector3d& point);

/// Left Jacobian of SE(3): exp((xi + d)^) = exp((J d)^) exp(xi^) to first order (Barfoot 7.85).
[[nodiscard]] Matrix6 se3_left_jacobian(const Twist& twist);

/// Angle between two rotations [rad], 0..pi (thesis 8.2, computed without the loss of acos near 0).
[[nodiscard]] double angle_between(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b);

/// From a to b on SO(3) x R^3: slerp of the rotation, straight line of the position; `fraction`
/// 0..1.
[[nodiscard]] Rigid3 interpolate(const Rigid3& a, const Rigid3& b, double fraction);

}  // namespace saccade
