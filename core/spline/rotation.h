#pragma once

#include <array>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/spline/segment.h"

namespace saccade {

/// The rotation part of a segment as the fits see it: a rotation and its derivative, where a small
/// change d of the parameters gives rotation * Exp(jacobian d).
template <int Parameters>
struct RotationWithJacobian {
  Eigen::Quaterniond rotation;
  Eigen::Matrix<double, 3, Parameters> jacobian;
};

/// Rotation from the start of a segment to its end, R(0)^-1 R(1), over the segment's three
/// increments:
///   Exp(-B_2(0) w_2) Exp((1 - B_1(0)) w_1) Exp(B_2(1) w_2) Exp(B_3(1) w_3).
[[nodiscard]] RotationWithJacobian<9> rotation_over_segment(const CumulativeBasis& basis,
                                                            const Eigen::Matrix3d& increments);

/// Rotation at one instant over the four control rotations Q_k <- Q_k Exp(d_k); `basis_value`: B_j
/// there.
[[nodiscard]] RotationWithJacobian<12> rotation_between(
    const Eigen::Array4d& basis_value, const std::array<Eigen::Quaterniond, 4>& controls);

/// Difference of the two increments between three control rotations and its derivative by their
/// right perturbations (3x9): zero at constant angular velocity.
struct RotationSecondDifference {
  Eigen::Vector3d value;
  Eigen::Matrix<double, 3, 9> jacobian;
};
[[nodiscard]] RotationSecondDifference rotation_second_difference(const Eigen::Quaterniond& a,
                                                                  const Eigen::Quaterniond& b,
                                                                  const Eigen::Quaterniond& c);

}  // namespace saccade
