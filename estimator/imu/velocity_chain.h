#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/LU>
#include <cstddef>
#include <vector>

namespace saccade {

/// Linear least squares over kHead global unknowns ("head") and a chain of velocities v_j. A row
/// involves the head and two neighbouring velocities: v_j is eliminated (Schur complement) as soon
/// as all of its rows are known, so that time and memory are linear in the chain's length.
class VelocityChain {
 public:
  static constexpr int kHead = 6;
  using Head = Eigen::Matrix<double, kHead, 1>;
  using HeadMatrix = Eigen::Matrix<double, kHead, kHead>;
  using Six = Eigen::Matrix<double, 6, 1>;

  /// The six equations of one interval, three for the position and three for the velocity,
  ///   value = rows * head + (T v_j; v_j - v_(j+1)).
  struct Rows {
    Eigen::Matrix<double, 6, kHead> head;
    Six value;
    double duration_s = 0;  ///< T
    Six weight;             ///< 1 / sigma
  };

  struct Solution {
    Head head;
    HeadMatrix covariance;
    std::vector<Eigen::Vector3d> velocities;  ///< one more than intervals
  };

  /// `precision`: 1 / sigma^2 of a zero-mean prior of the head.
  explicit VelocityChain(const Head& precision) {
    information_.setZero();
    right_.setZero();
    information_.diagonal().tail<kHead>() = precision;
    free_velocity();
  }

  /// Adds the equations of the next interval.
  void add(const Rows& rows) {
    Eigen::Matrix<double, 6, kHead + 6> full = Eigen::Matrix<double, 6, kHead + 6>::Zero();
    full.block<3, 3>(0, 0) = rows.duration_s * Eigen::Matrix3d::Identity();
    full.block<3, 3>(3, 0).setIdentity();
    full.block<3, 3>(3, 3) = -Eigen::Matrix3d::Identity();
    full.rightCols<kHead>() = rows.head;
    const Eigen::Matrix<double, 6, 6> weight =
        Eigen::Matrix<double, 6, 6>(rows.weight.cwiseAbs2().asDiagonal());
    const Eigen::Matrix<double, 6, kHead + 6> weighted = weight * full;
    link(full.transpose() * weighted, weighted.transpose() * rows.value);
  }

  /// Adds an interval without equations: the next velocity is independent.
  void skip() { link(Wide::Zero(), WideVector::Zero()); }

  [[nodiscard]] Solution solve() const {
    const Eigen::LDLT<Eigen::Matrix<double, kHead + 3, kHead + 3>> factor(information_);
    const Narrow inverse = factor.solve(Narrow::Identity());
    const NarrowVector last = inverse * right_;
    Solution solution;
    solution.head = last.tail<kHead>();
    solution.covariance = inverse.bottomRightCorner<kHead, kHead>();
    solution.velocities.assign(links_.size() + 1, last.head<3>());
    NarrowVector next = last;
    for (std::size_t j = links_.size(); j-- > 0;) {
      solution.velocities[j] = links_[j].value - links_[j].by_next * next;
      next.head<3>() = solution.velocities[j];
    }
    return solution;
  }

 private:
  using Narrow = Eigen::Matrix<double, kHead + 3, kHead + 3>;
  using NarrowVector = Eigen::Matrix<double, kHead + 3, 1>;
  using Wide = Eigen::Matrix<double, kHead + 6, kHead + 6>;
  using WideVector = Eigen::Matrix<double, kHead + 6, 1>;

  /// v_j = value - by_next (v_(j+1), head).
  struct Link {
    Eigen::Matrix<double, 3, kHead + 3> by_next;
    Eigen::Vector3d value;
  };

  /// A velocity without equations is zero.
  void free_velocity() { information_.topLeftCorner<3, 3>().diagonal().array() += 1e-9; }

  /// Adds to the normal equations of (v_j, v_(j+1), head) and eliminates v_j.
  void link(Wide information, WideVector right) {
    information.topLeftCorner<3, 3>() += information_.topLeftCorner<3, 3>();
    information.topRightCorner<3, kHead>() += information_.topRightCorner<3, kHead>();
    information.bottomLeftCorner<kHead, 3>() += information_.bottomLeftCorner<kHead, 3>();
    information.bottomRightCorner<kHead, kHead>() += information_.bottomRightCorner<kHead, kHead>();
    right.head<3>() += right_.head<3>();
    right.tail<kHead>() += right_.tail<kHead>();
    const Eigen::Matrix3d inverse = information.topLeftCorner<3, 3>().inverse();
    const Eigen::Matrix<double, 3, kHead + 3> cross = information.topRightCorner<3, kHead + 3>();
    const Link link{inverse * cross, inverse * right.head<3>()};
    information_ =
        information.bottomRightCorner<kHead + 3, kHead + 3>() - cross.transpose() * link.by_next;
    right_ = right.tail<kHead + 3>() - cross.transpose() * link.value;
    links_.push_back(link);
    free_velocity();
  }

  Narrow information_;  ///< of (v_j, head), j the last
  NarrowVector right_;
  std::vector<Link> links_;
};

}  // namespace saccade
