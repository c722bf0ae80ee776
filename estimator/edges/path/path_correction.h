#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "core/spline/knots.h"
#include "core/trajectory.h"

namespace saccade {

/// A correction of a camera's path, a cubic spline of twists:
///   world_from_camera(t) = given(t) exp(xi(t)),   xi(t) = sum of weight_k(t) xi_k.
class PathCorrection {
 public:
  static constexpr int kSize = 6;

  explicit PathCorrection(const SplineKnots& knots) : knots_(knots), twists_(knots.controls()) {
    for (auto& twist : twists_) twist.fill(0);
  }

  [[nodiscard]] const SplineKnots& knots() const { return knots_; }
  [[nodiscard]] double* data(std::size_t control) { return twists_[control].data(); }
  /// The six numbers of all controls, one after the other.
  [[nodiscard]] std::span<double> unknowns() {
    return {twists_.front().data(), kSize * twists_.size()};
  }
  [[nodiscard]] Twist control(std::size_t i) const {
    return Eigen::Map<const Twist>(twists_[i].data());
  }
  [[nodiscard]] Twist at(double t_s) const {
    const SplineKnots::LocalBasis basis = knots_.at(t_s);
    Twist twist = Twist::Zero();
    for (std::size_t k = 0; k < 4; ++k)
      twist += basis.weight[static_cast<Eigen::Index>(k)] * control(basis.first + k);
    return twist;
  }
  [[nodiscard]] Trajectory applied(const Trajectory& given) const {
    std::vector<StampedPose> poses(given.poses().begin(), given.poses().end());
    for (StampedPose& pose : poses)
      pose.world_from_camera = pose.world_from_camera * Rigid3::exp(at(pose.t_s));
    return Trajectory(std::move(poses));
  }

 private:
  SplineKnots knots_;
  std::vector<std::array<double, kSize>> twists_;
};

}  // namespace saccade
