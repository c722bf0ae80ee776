#include "estimator/edges/path/inertial_cost.h"

#include "estimator/edges/least_squares/jacobian_block.h"
#include "estimator/edges/path/path_correction.h"

namespace saccade {

InertialFrame InertialFrame::about(const Eigen::Vector3d& gravity_m_s2) {
  InertialFrame frame;
  frame.gravity = gravity_m_s2.norm();
  frame.direction = gravity_m_s2 / frame.gravity;
  frame.across.col(0) = frame.direction.unitOrthogonal();
  frame.across.col(1) = frame.direction.cross(Eigen::Vector3d(frame.across.col(0)));
  return frame;
}

Eigen::Vector3d InertialFrame::gravity_at(const Eigen::Vector2d& tilt) const {
  return gravity * (direction + across * tilt).normalized();
}

Eigen::Matrix<double, 3, 2> InertialFrame::by_tilt(const Eigen::Vector2d& tilt) const {
  const Eigen::Vector3d rotated = direction + across * tilt;
  const Eigen::Vector3d unit = rotated.normalized();
  const Eigen::Matrix3d flat = Eigen::Matrix3d::Identity() - unit * unit.transpose();
  return gravity / rotated.norm() * flat * across;
}

InertialCost::InertialCost(const std::array<InertialNode, 2>& nodes, const Preintegration& sum,
                           const Eigen::Vector3d& imu_in_camera, const InertialFrame& frame,
                           const Matrix9& root)
    : nodes_(nodes), sum_(sum), imu_in_camera_(imu_in_camera), frame_(frame), root_(root) {
  set_num_residuals(9);
  mutable_parameter_block_sizes()->assign(controls(), PathCorrection::kSize);
  for (const int size : {3, 3, 6, InertialFrame::kSize})
    mutable_parameter_block_sizes()->push_back(size);
}

InertialCost::Pose InertialCost::pose(int node, double const* const* parameters,
                                      double offset_s) const {
  const InertialNode& at = nodes_[static_cast<std::size_t>(node)];
  const std::size_t first = at.basis.first - first_control();
  Twist twist = Twist::Zero();
  for (std::size_t k = 0; k < 4; ++k)
    twist += at.basis.weight[static_cast<Eigen::Index>(k)] *
             Eigen::Map<const Twist>(parameters[first + k]);
  const Rigid3 moved = Rigid3::exp(offset_s * at.motion);
  return {at.given * Rigid3::exp(twist) * moved,
          moved.inverse().adjoint() * se3_left_jacobian(-twist)};
}

bool InertialCost::Evaluate(double const* const* parameters, double* residuals,
                            double** jacobians) const {
  using Vector3 = Eigen::Vector3d;
  const std::size_t n = controls();
  const Eigen::Map<const Vector3> v_i(parameters[n]), v_j(parameters[n + 1]);
  const Eigen::Map<const Twist> bias(parameters[n + 2]);
  const Eigen::Map<const InertialFrame::Vector> shared(parameters[n + 3]);
  const double scale = shared[InertialFrame::kScale];
  const double t_s = sum_.duration_s;
  const Pose at_i = pose(0, parameters, shared[InertialFrame::kOffset]);
  const Pose at_j = pose(1, parameters, shared[InertialFrame::kOffset]);
  const Eigen::Matrix3d back = at_i.world_from_camera.rotation_matrix().transpose();
  const Eigen::Matrix3d rotation = back * at_j.world_from_camera.rotation_matrix();
  const Vector3 baseline =
      at_j.world_from_camera.translation() - at_i.world_from_camera.translation();
  const Vector3 gravity = frame_.gravity_at(shared.head<2>());
  const ImuBias other{bias.head<3>(), bias.tail<3>()};
  const Eigen::Quaterniond rotation_error =
      sum_.rotation_with(other).conjugate() * Eigen::Quaterniond(rotation);
  const Vector3 rotated = so3_log(rotation_error);
  const Vector3 gained = back * (v_j - v_i - t_s * gravity);
  const Vector3 moved = back * (scale * baseline - t_s * v_i - 0.5 * t_s * t_s * gravity);
  Eigen::Matrix<double, 9, 1> error;
  error.head<3>() = rotated;
  error.segment<3>(3) = gained - sum_.velocity_with(other);
  error.tail<3>() = moved + rotation * imu_in_camera_ - imu_in_camera_ - sum_.position_with(other);
  Eigen::Map<Eigen::Matrix<double, 9, 1>> whitened(residuals);
  whitened = root_ * error;
  if (jacobians == nullptr) return true;

  // By the right perturbations (v, w) of both poses; that of Log is J_r^-1 (Forster et al., 2017).
  const Eigen::Matrix3d by_last = so3_left_jacobian_inverse(-rotated);
  Rows6 by_i = Rows6::Zero(), by_j = Rows6::Zero();
  by_i.block<3, 3>(0, 3) = -by_last * rotation.transpose();
  by_j.block<3, 3>(0, 3) = by_last;
  by_i.block<3, 3>(3, 3) = skew(gained);
  by_i.block<3, 3>(6, 0) = -scale * Eigen::Matrix3d::Identity();
  by_i.block<3, 3>(6, 3) = skew(moved + rotation * imu_in_camera_);
  by_j.block<3, 3>(6, 0) = scale * rotation;
  by_j.block<3, 3>(6, 3) = -rotation * skew(imu_in_camera_);
  by_i = root_ * by_i;
  by_j = root_ * by_j;
  const Rows6 by_twist_i = by_i * at_i.by_twist, by_twist_j = by_j * at_j.by_twist;
  const std::size_t later = nodes_[1].basis.first - first_control();
  for (std::size_t k = 0; k < n; ++k) {
    Rows6 by_control = Rows6::Zero();
    if (k < 4) by_control += nodes_[0].basis.weight[static_cast<Eigen::Index>(k)] * by_twist_i;
    if (k >= later)
      by_control += nodes_[1].basis.weight[static_cast<Eigen::Index>(k - later)] * by_twist_j;
    write_block(jacobians[k], by_control);
  }
  Eigen::Matrix<double, 9, 3> by_v_i = Eigen::Matrix<double, 9, 3>::Zero(), by_v_j = by_v_i;
  by_v_i.middleRows<3>(3) = -back;
  by_v_i.bottomRows<3>() = -t_s * back;
  by_v_j.middleRows<3>(3) = back;
  write_block(jacobians[n], Eigen::Matrix<double, 9, 3>(root_ * by_v_i));
  write_block(jacobians[n + 1], Eigen::Matrix<double, 9, 3>(root_ * by_v_j));
  Rows6 bias_jacobian = -sum_.bias_jacobian;
  const Vector3 drift =
      sum_.bias_jacobian.topLeftCorner<3, 3>() * Vector3(other.gyro - sum_.bias.gyro);
  bias_jacobian.topRows<3>() = -so3_left_jacobian_inverse(rotated) * so3_left_jacobian(-drift) *
                               sum_.bias_jacobian.topRows<3>();
  write_block(jacobians[n + 2], Rows6(root_ * bias_jacobian));
  Eigen::Matrix<double, 9, InertialFrame::kSize> by_frame;
  by_frame.setZero();
  const Eigen::Matrix<double, 3, 2> falling = back * frame_.by_tilt(shared.head<2>());
  by_frame.block<3, 2>(3, 0) = -t_s * falling;
  by_frame.block<3, 2>(6, 0) = -0.5 * t_s * t_s * falling;
  by_frame.block<3, 1>(6, InertialFrame::kScale) = back * baseline;
  by_frame = root_ * by_frame;
  by_frame.col(InertialFrame::kOffset) = by_i * nodes_[0].motion + by_j * nodes_[1].motion;
  write_block(jacobians[n + 3], by_frame);
  return true;
}

}  // namespace saccade
