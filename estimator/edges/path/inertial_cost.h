#pragma once

#include <array>

#include <Eigen/Core>

#include <ceres/cost_function.h>

#include "core/rigid3.h"
#include "core/spline/knots.h"
#include "estimator/imu/preintegration.h"

namespace saccade {

/// What all inertial residuals share: gravity's rotation t about a direction d, metres in the path's
/// unit s, and the offset of the samples' clock, o [s].
struct InertialFrame {
  static constexpr int kSize = 4;
  static constexpr int kScale = 2, kOffset = 3;
  using Vector = Eigen::Matrix<double, kSize, 1>;

  double gravity = 9.81;               ///< G [m/s^2]
  Eigen::Vector3d direction;           ///< d, unit, in the path's world
  Eigen::Matrix<double, 3, 2> across;  ///< B, unit vectors across d

  /// The frame about the direction of some gravity.
  [[nodiscard]] static InertialFrame about(const Eigen::Vector3d& gravity_m_s2);

  /// g = G (d + B t) / |d + B t|, and its derivative by t.
  [[nodiscard]] Eigen::Vector3d gravity_at(const Eigen::Vector2d& tilt) const;
  [[nodiscard]] Eigen::Matrix<double, 3, 2> by_tilt(const Eigen::Vector2d& tilt) const;
};

/// An instant of the path at which samples begin or end.
struct InertialNode {
  Rigid3 given;                   ///< world_from_camera before the correction
  Twist motion;                   ///< of the camera, in its axes [unit/s, rad/s]
  SplineKnots::LocalBasis basis;  ///< its four controls in the correction
};

/// Preintegrated samples between two instants of a path (Forster et al., TRO 2017, with the
/// sensor beside the camera and an unknown scale) against the path:
///   X_i = given_i Exp(xi_i) Exp(o motion_i) = (R_i, p_i)
///   r = W ( Log(Q(b)^T R_i^T R_j),
///           R_i^T (v_j - v_i - g T) - V(b),
///           R_i^T (s (p_j - p_i) + R_j x - v_i T - g T^2 / 2) - x - P(b) )
/// with x the sensor's position in the camera, v its velocity [m/s], b its biases. Parameters: the
/// controls of the correction from the first of node i's to the last of node j's, v_i, v_j, b
/// (gyroscope, accelerometer), the inertial frame (t, s, o).
class InertialCost : public ceres::CostFunction {
 public:
  using Matrix9 = Preintegration::Matrix9;

  /// `root`: W. `frame` must outlive the cost.
  InertialCost(const std::array<InertialNode, 2>& nodes, const Preintegration& sum,
               const Eigen::Vector3d& imu_in_camera, const InertialFrame& frame,
               const Matrix9& root);

  [[nodiscard]] std::size_t first_control() const { return nodes_[0].basis.first; }
  [[nodiscard]] std::size_t controls() const {
    return nodes_[1].basis.first + 4 - nodes_[0].basis.first;
  }

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  using Rows6 = Eigen::Matrix<double, 9, 6>;

  /// A node's pose, and how it changes to the right with the correction's twist there.
  struct Pose {
    Rigid3 world_from_camera;
    Matrix6 by_twist;
  };
  [[nodiscard]] Pose pose(int node, double const* const* parameters, double offset_s) const;

  std::array<InertialNode, 2> nodes_;
  Preintegration sum_;
  Eigen::Vector3d imu_in_camera_;
  const InertialFrame& frame_;
  Matrix9 root_;
};

}  // namespace saccade
