#include "estimator/imu/inertial_alignment.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/rigid3.h"
#include "core/spline/spline.h"
#include "estimator/imu/rest_detector.h"
#include "estimator/imu/velocity_chain.h"

namespace saccade {
namespace {

constexpr int kRounds = 10;
constexpr std::size_t kMinIntervals = 8;
constexpr double kSmoothing_s = 0.05;      ///< knot spacing of the spline that smooths the path
constexpr double kPositionSigma = 1e-3;    ///< of a position, relative to the typical depth
constexpr double kTiltSigma_rad = 2e-3;    ///< of an orientation of the path
constexpr double kAlignedBiasSigma = 0.2;  ///< [m/s^2]
constexpr double kMaxScaleSigma = 0.05;    ///< relative; a larger sigma is kUnobservableScale
constexpr double kMaxResidual = 2;         ///< a larger residual is kInconsistent
constexpr double kCauchyScale = 3;         ///< of the loss of an interval [sigma]

using Chain = VelocityChain;
using Matrix32 = Eigen::Matrix<double, 3, 2>;

/// The preintegrated samples between two nodes of the path.
struct Interval {
  std::size_t node;  ///< the first of the two
  Preintegration sum;
};

/// Orthonormal basis of the tangent plane of a unit vector (B).
Matrix32 tangent_basis(const Eigen::Vector3d& direction) {
  Matrix32 basis;
  basis.col(0) = direction.unitOrthogonal();
  basis.col(1) = direction.cross(basis.col(0));
  return basis;
}

/// Poses of the smoothed path at equal intervals.
std::vector<StampedPose> nodes_of(const Trajectory& path, double interval_s) {
  const Spline spline = Spline::smooth(path.poses(), kSmoothing_s);
  const double length_s = spline.end_s() - spline.start_s();
  const auto count = static_cast<std::size_t>(length_s / interval_s);
  std::vector<StampedPose> nodes;
  for (std::size_t j = 0; j <= count; ++j) {
    const double t_s = spline.start_s() + static_cast<double>(j) * interval_s;
    nodes.push_back({t_s, spline.pose(t_s)});
  }
  return nodes;
}

class Alignment {
 public:
  Alignment(const Trajectory& path, const MountedImu& imu, double typical_depth_m,
            double interval_s)
      : imu_(imu),
        position_sigma_(kPositionSigma * typical_depth_m),
        nodes_(nodes_of(path, interval_s)) {}

  [[nodiscard]] InertialAlignment solve() {
    for (int round = 0; round < kRounds; ++round) {
      preintegrate_all();
      if (intervals_.size() < kMinIntervals) return result_;
      solve_rotations();
    }
    preintegrate_all();
    if (intervals_.size() < kMinIntervals) return result_;
    weights_.assign(intervals_.size(), 1);
    initialise_gravity();
    const Eigen::Vector3d mean_force_gravity = result_.gravity;
    for (int round = 0; round < kRounds; ++round) solve_translations();
    result_.intervals = intervals_.size();
    result_.status = status();
    // Without enough acceleration, gravity and accelerometer bias cannot be separated.
    if (result_.status != InertialAlignment::Status::kOk) {
      result_.gravity = mean_force_gravity;
      result_.bias.accel.setZero();
    }
    return result_;
  }

 private:
  [[nodiscard]] InertialAlignment::Status status() const {
    using Status = InertialAlignment::Status;
    if (result_.residual > kMaxResidual) return Status::kInconsistent;
    const bool is_known = result_.scale > 0 && result_.scale_sigma < kMaxScaleSigma;
    return is_known ? Status::kOk : Status::kUnobservableScale;
  }

  void preintegrate_all() {
    intervals_.clear();
    for (std::size_t j = 0; j + 1 < nodes_.size(); ++j) {
      const double from_s = nodes_[j].t_s - result_.time_offset_s;
      const double to_s = nodes_[j + 1].t_s - result_.time_offset_s;
      if (auto sum = preintegrate(imu_.samples, from_s, to_s, result_.bias, imu_.noise))
        intervals_.push_back({j, *sum});
    }
  }

  /// One Gauss-Newton step of gyroscope bias and time offset by (a).
  void solve_rotations() {
    Eigen::Matrix4d information = Eigen::Matrix4d::Zero();
    Eigen::Vector4d right = Eigen::Vector4d::Zero();
    for (const Interval& interval : intervals_) {
      const Preintegration& sum = interval.sum;
      const Eigen::Quaterniond& a = nodes_[interval.node].world_from_camera.rotation();
      const Eigen::Quaterniond& b = nodes_[interval.node + 1].world_from_camera.rotation();
      const Eigen::Vector3d residual = so3_log(sum.rotation.conjugate() * a.conjugate() * b);
      Eigen::Matrix<double, 3, 4> jacobian;
      jacobian.leftCols<3>() = sum.bias_jacobian.topLeftCorner<3, 3>();
      // A larger offset means earlier samples.
      jacobian.col(3) = sum.rotation.conjugate() * sum.first_rate - sum.last_rate;
      information += jacobian.transpose() * jacobian;
      right += jacobian.transpose() * residual;
    }
    // A constant rate does not determine the offset, which then stays 0.
    information(3, 3) += 1e-6;
    const Eigen::Vector4d step = information.ldlt().solve(right);
    result_.bias.gyro += step.head<3>();
    result_.time_offset_s += step[3];
  }

  /// Solves for the head of `rows_of(interval)` over all intervals.
  template <class MakeRows>
  [[nodiscard]] Chain::Solution least_squares(const Chain::Head& precision,
                                              const MakeRows& rows_of) const {
    Chain chain(precision);
    std::size_t node = 0;
    for (std::size_t k = 0; k < intervals_.size(); ++k) {
      for (; node < intervals_[k].node; ++node) chain.skip();
      Chain::Rows rows = rows_of(intervals_[k]);
      rows.weight *= weights_[k];
      chain.add(rows);
      ++node;
    }
    return chain.solve();
  }

  /// Equations (b), (c) of an interval without the head: weights from the path's sigmas, and values.
  [[nodiscard]] Chain::Rows rows_without_head(const Interval& interval) const {
    const double t_s = interval.sum.duration_s;
    const double velocity_sigma = kGravity_m_s2 * kTiltSigma_rad * t_s / result_.scale;
    const double position_sigma = std::hypot(position_sigma_, 0.5 * t_s * velocity_sigma);
    Chain::Rows rows;
    rows.duration_s = t_s;
    rows.weight.head<3>().setConstant(1 / position_sigma);
    rows.weight.tail<3>().setConstant(1 / velocity_sigma);
    rows.value.setZero();
    rows.value.head<3>() = nodes_[interval.node + 1].world_from_camera.translation() -
                           nodes_[interval.node].world_from_camera.translation();
    return rows;
  }

  /// Measured change of position and velocity in the path's world, without gravity [m, m/s].
  [[nodiscard]] Chain::Six measured_change(const Interval& interval) const {
    const Rigid3& a = nodes_[interval.node].world_from_camera;
    const Rigid3& b = nodes_[interval.node + 1].world_from_camera;
    Chain::Six sum;
    sum.head<3>() = a.rotation() * interval.sum.position - (b.rotation() * imu_.position_in_camera -
                                                            a.rotation() * imu_.position_in_camera);
    sum.tail<3>() = a.rotation() * interval.sum.velocity;
    return sum;
  }

  /// Its Jacobian with respect to the biases (gyro, accel).
  [[nodiscard]] Matrix6 change_by_bias(const Interval& interval) const {
    const Eigen::Matrix3d rotation = nodes_[interval.node].world_from_camera.rotation_matrix();
    Matrix6 jacobian;
    jacobian.topRows<3>() = rotation * interval.sum.bias_jacobian.bottomRows<3>();
    jacobian.bottomRows<3>() = rotation * interval.sum.bias_jacobian.middleRows<3>(3);
    return jacobian;
  }

  /// Position and velocity after t_s of constant acceleration, a column for each.
  template <int kColumns>
  static Eigen::Matrix<double, 6, kColumns> constant_acceleration(
      double t_s, const Eigen::Matrix<double, 3, kColumns>& directions) {
    Eigen::Matrix<double, 6, kColumns> columns;
    columns.template topRows<3>() = 0.5 * t_s * t_s * directions;
    columns.template bottomRows<3>() = t_s * directions;
    return columns;
  }

  /// Gravity from the mean specific force: over the whole path the velocity hardly changes.
  void initialise_gravity() {
    Eigen::Vector3d force = Eigen::Vector3d::Zero();
    for (const Interval& interval : intervals_) force += measured_change(interval).tail<3>();
    if (force.norm() > 0) direction_ = -force.normalized();
    result_.gravity = kGravity_m_s2 * direction_;
  }

  /// Solves (b), (c) for (l, l t, l c), linearised about the previous direction d.
  void solve_translations() {
    const Matrix32 basis = tangent_basis(direction_);
    const auto rows_of = [&](const Interval& interval) {
      const Matrix6 jacobian = change_by_bias(interval);
      Chain::Rows rows = rows_without_head(interval);
      rows.head.col(0) =
          measured_change(interval) +
          constant_acceleration<1>(rows.duration_s, Eigen::Vector3d(kGravity_m_s2 * direction_));
      rows.head.middleCols<2>(1) = constant_acceleration<2>(rows.duration_s, kGravity_m_s2 * basis);
      rows.head.rightCols<3>() = jacobian.rightCols<3>();
      return rows;
    };
    Chain::Head precision = Chain::Head::Zero();
    precision.tail<3>().setConstant(std::pow(result_.scale / kAlignedBiasSigma, 2));
    const Chain::Solution found = least_squares(precision, rows_of);
    update(found, basis);
    reweight(found, rows_of);
  }

  void update(const Chain::Solution& found, const Matrix32& basis) {
    const double inverse = found.head[0];
    if (!(inverse > 0)) {
      result_.scale_sigma = std::numeric_limits<double>::infinity();
      return;
    }
    result_.scale = 1 / inverse;
    result_.scale_sigma = std::sqrt(found.covariance(0, 0)) / inverse;
    const Eigen::Vector2d t = found.head.segment<2>(1) / inverse;
    result_.tilt_sigma_rad = std::sqrt(found.covariance.block<2, 2>(1, 1).trace() / 2) / inverse;
    direction_ = (direction_ + basis * t).normalized();
    result_.gravity = kGravity_m_s2 * direction_;
    result_.bias.accel = found.head.tail<3>() / inverse;
  }

  /// Cauchy weights of the intervals; the sigmas are inflated by the RMS residual.
  template <class MakeRows>
  void reweight(const Chain::Solution& found, const MakeRows& rows_of) {
    double squares = 0, weight_sum = 0;
    for (std::size_t k = 0; k < intervals_.size(); ++k) {
      const Chain::Rows rows = rows_of(intervals_[k]);
      const Eigen::Vector3d& before = found.velocities[intervals_[k].node];
      const Eigen::Vector3d& after = found.velocities[intervals_[k].node + 1];
      Chain::Six error = rows.value - rows.head * found.head;
      error.head<3>() -= rows.duration_s * before;
      error.tail<3>() -= before - after;
      const double square = rows.weight.cwiseProduct(error).squaredNorm() / 6;
      squares += weights_[k] * weights_[k] * square;
      weight_sum += weights_[k] * weights_[k];
      weights_[k] = 1 / std::sqrt(1 + square / (kCauchyScale * kCauchyScale));
    }
    // Six equations and three unknowns for each interval.
    result_.residual = std::sqrt(2 * squares / weight_sum);
    const double inflation = std::max(1.0, result_.residual);
    result_.scale_sigma *= inflation;
    result_.tilt_sigma_rad *= inflation;
  }

  const MountedImu& imu_;
  double position_sigma_;  ///< of a position of the path, in its unit
  std::vector<StampedPose> nodes_;
  std::vector<Interval> intervals_;
  std::vector<double> weights_;                            ///< of each interval
  Eigen::Vector3d direction_ = -Eigen::Vector3d::UnitZ();  ///< d
  InertialAlignment result_;
};

}  // namespace

Eigen::Quaterniond InertialAlignment::gravity_alignment() const {
  return Eigen::Quaterniond::FromTwoVectors(gravity, -Eigen::Vector3d::UnitZ());
}

InertialAlignment align_inertially(const Trajectory& path, const MountedImu& imu,
                                   double typical_depth_m, double interval_s) {
  return Alignment(path, imu, typical_depth_m, interval_s).solve();
}

}  // namespace saccade
