#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/check.h"
#include "core/error.h"
#include "core/spline/banded.h"
#include "core/spline/knots.h"
#include "core/spline/rotation.h"
#include "core/spline/spline.h"

namespace saccade {
namespace {

using Index = Eigen::Index;

/// Weight of smoothness (second differences of the control poses) against one sample per segment.
/// It decides where samples are missing and is far below any measurement elsewhere.
constexpr double kSmoothness = 1e-6;

/// Least squares over uniform knots: samples at (segment, u), control poses 0 .. segments + 2.
class Smoothing {
 public:
  Smoothing(std::span<const StampedPose> poses, Index segments)
      : poses_(poses),
        segments_(segments),
        basis_(bases_between(std::vector<double>{0, 1}).front()),
        start_s_(poses.front().t_s),
        spacing_s_((poses.back().t_s - start_s_) / static_cast<double>(segments)),
        smoothness_(kSmoothness * std::max(1.0, static_cast<double>(poses.size()) /
                                                    static_cast<double>(segments))) {}

  [[nodiscard]] std::vector<Rigid3> solve() const {
    const Eigen::MatrixXd positions = solve_positions();
    const Rotations rotations = solve_rotations();
    std::vector<Rigid3> controls;
    for (Index k = 0; k < controls_count(); ++k) {
      controls.emplace_back(rotations[static_cast<std::size_t>(k)], positions.row(k).transpose());
    }
    return controls;
  }

 private:
  using Rotations = std::vector<Eigen::Quaterniond>;

  [[nodiscard]] Index controls_count() const { return segments_ + 3; }

  /// Calls `visit(segment, basis value, pose)` for every sample.
  template <class Visit>
  void for_each_sample(const Visit& visit) const {
    for (const StampedPose& sample : poses_) {
      const double x = (sample.t_s - start_s_) / spacing_s_;
      const Index segment = std::min(static_cast<Index>(x), segments_ - 1);
      visit(segment, basis_.value(x - static_cast<double>(segment)), sample.world_from_camera);
    }
  }

  [[nodiscard]] Eigen::MatrixXd solve_positions() const {
    // Relative to the first pose, so that a far-away origin costs no digits.
    const Eigen::Vector3d origin = poses_.front().world_from_camera.translation();
    BandedLeastSquares system(controls_count(), 3, 3);
    for_each_sample([&](Index segment, const Eigen::Array4d& b, const Rigid3& pose) {
      const Eigen::RowVector4d weights(1 - b[0], b[0] - b[1], b[1] - b[2], b[2]);
      const Eigen::RowVector3d target = (pose.translation() - origin).transpose();
      system.add(segment, weights, target);
    });
    const Eigen::RowVector3d second_difference =
        std::sqrt(smoothness_) * Eigen::RowVector3d(1, -2, 1);
    for (Index k = 0; k + 2 < controls_count(); ++k) {
      system.add(k, second_difference, Eigen::RowVector3d::Zero());
    }
    std::optional<Eigen::MatrixXd> positions = system.solve();
    SACCADE_CHECK(positions.has_value());
    positions->rowwise() += origin.transpose();
    return *positions;
  }

  /// The linearisation about some control rotations, and their squared error.
  struct Linearised {
    BandedLeastSquares system;
    double cost;
  };

  /// Gauss-Newton over right perturbations of the control rotations; a step that would raise the
  /// squared error (large residuals of coarse knots) is halved.
  [[nodiscard]] Rotations solve_rotations() const {
    constexpr int kMaxIterations = 200;
    constexpr double kStepTolerance = 1e-9;
    constexpr double kCostTolerance = 1e-12;
    Rotations controls = first_rotations();
    Linearised at = linearised(controls);
    double length = 1;
    for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
      const std::optional<Eigen::MatrixXd> step = at.system.solve();
      if (!step || !step->allFinite()) break;
      const double reach = step->cwiseAbs().maxCoeff();
      length = std::min(1.0, 2 * length);
      Rotations candidate = rotated(controls, length * *step);
      Linearised there = linearised(candidate);
      while (there.cost > at.cost && length * reach > kStepTolerance) {
        length /= 2;
        candidate = rotated(controls, length * *step);
        there = linearised(candidate);
      }
      const bool done =
          length * reach <= kStepTolerance || at.cost - there.cost <= kCostTolerance * at.cost;
      controls = std::move(candidate);
      at = std::move(there);
      if (done) return controls;
    }
    throw InputError(
        {}, fmt::format("the smoothing spline with knots {} s apart does not converge on these "
                        "rotations; choose a shorter spacing",
                        spacing_s_));
  }

  [[nodiscard]] static Rotations rotated(Rotations controls, const Eigen::MatrixXd& step) {
    for (std::size_t k = 0; k < controls.size(); ++k) {
      const Eigen::Vector3d rotation_vector = step.middleRows<3>(3 * static_cast<Index>(k));
      controls[k] = (controls[k] * so3_exp(rotation_vector)).normalized();
    }
    return controls;
  }

  /// The samples' rotations at the times where control pose k has its greatest weight.
  [[nodiscard]] Rotations first_rotations() const {
    const Trajectory trajectory(std::vector<StampedPose>(poses_.begin(), poses_.end()));
    Rotations controls;
    for (Index k = 0; k < controls_count(); ++k) {
      const double t = start_s_ + static_cast<double>(k - 1) * spacing_s_;
      controls.push_back(trajectory.at_clamped(t).rotation());
    }
    return controls;
  }

  [[nodiscard]] Linearised linearised(const Rotations& controls) const {
    Linearised result{BandedLeastSquares(3 * controls_count(), 11, 1), 0};
    for_each_sample([&](Index segment, const Eigen::Array4d& b, const Rigid3& pose) {
      const auto k = static_cast<std::size_t>(segment);
      const auto at =
          rotation_between(b, {controls[k], controls[k + 1], controls[k + 2], controls[k + 3]});
      const Eigen::Vector3d residual = so3_log(at.rotation.conjugate() * pose.rotation());
      result.system.add(3 * segment, at.jacobian, residual);
      result.cost += residual.squaredNorm();
    });
    const double weight = std::sqrt(smoothness_);
    for (std::size_t k = 0; k + 2 < controls.size(); ++k) {
      const RotationSecondDifference u =
          rotation_second_difference(controls[k], controls[k + 1], controls[k + 2]);
      result.system.add(3 * static_cast<Index>(k), weight * u.jacobian, -weight * u.value);
      result.cost += smoothness_ * u.value.squaredNorm();
    }
    return result;
  }

  std::span<const StampedPose> poses_;
  Index segments_;
  CumulativeBasis basis_;
  double start_s_;
  double spacing_s_;
  double smoothness_;
};

}  // namespace

SplineControls SplineControls::smooth(std::span<const StampedPose> poses, double knot_spacing_s) {
  SACCADE_CHECK(poses.size() >= 2 && knot_spacing_s > 0);
  const SplineKnots knots = SplineKnots::over(poses.front().t_s, poses.back().t_s, knot_spacing_s);
  return {knots, Smoothing(poses, static_cast<Index>(knots.segments)).solve()};
}

Spline Spline::smooth(std::span<const StampedPose> poses, double knot_spacing_s) {
  return SplineControls::smooth(poses, knot_spacing_s).spline();
}

}  // namespace saccade
