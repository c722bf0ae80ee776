#pragma once

#include <Eigen/Cholesky>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include <ceres/sized_cost_function.h>

#include "core/camera.h"
#include "core/rigid3.h"
#include "estimator/edges/edge_noise.h"
#include "estimator/edges/edge_residual.h"
#include "estimator/edges/least_squares/jacobian_block.h"
#include "estimator/edges/window/node_correction.h"

namespace saccade {

/// A root W of the information about a twist (v, w) of a camera whose image is known to move by
/// `sigma_px`, RMS, whatever is in view at half to twice the depth:
///   W^T W = mean over pixels and depths of J^T J / sigma^2,  J the image motion of the twist
/// (Longuet-Higgins and Prazdny, 1980). Motions that look alike are hardly distinguished.
[[nodiscard]] inline Matrix6 image_motion_sqrt_information(const PinholeCamera& camera,
                                                           double depth_m, double sigma_px) {
  constexpr int kGrid = 5;
  Matrix6 information = Matrix6::Zero();
  double count = 0;
  for (const double depth : {depth_m / 2, depth_m, 2 * depth_m})
    for (int i = 0; i < kGrid; ++i)
      for (int j = 0; j < kGrid; ++j) {
        const Eigen::Vector3d ray = camera.ray(
            {(i + 0.5) / kGrid * camera.width - 0.5, (j + 0.5) / kGrid * camera.height - 0.5});
        Eigen::Matrix<double, 2, 6> motion;
        motion << Eigen::Matrix2d::Identity() / depth, -ray.head<2>() / depth,
            (Eigen::Matrix<double, 2, 3>() << -ray.x() * ray.y(), 1 + ray.x() * ray.x(), -ray.y(),
             -1 - ray.y() * ray.y(), ray.x() * ray.y(), ray.x())
                .finished();
        motion.row(0) *= camera.fx / sigma_px;
        motion.row(1) *= camera.fy / sigma_px;
        information += motion.transpose() * motion;
        ++count;
      }
  return (information / count).llt().matrixU();
}

/// What a Cauchy loss a^2 ln(1 + (r/a)^2) makes of a residual r: r' with r'^2 the loss, and dr'/dr.
[[nodiscard]] inline std::pair<double, double> cauchy_residual(double residual, double scale) {
  const double squared = (residual / scale) * (residual / scale);
  // The series of sqrt(log1p(x) / x), where the quotient has no digits left.
  const double shrunk = squared < 1e-8 ? 1 - squared / 4 : std::sqrt(std::log1p(squared) / squared);
  return {residual * shrunk, 1 / (shrunk * (1 + squared))};
}

/// An event of an edge between two nodes of a path's correction.
struct ObservedEvent {
  EdgeObservation observation;
  int node = 0;         ///< the earlier
  double fraction = 0;  ///< s of the later, 0..1
};

/// The residuals of edge_residual.h of two events of one edge between the same two nodes, over
/// their sigma: a pair, because of Ceres' Schur eliminators the one for rows of two with blocks of
/// four and six is compiled for these sizes, and that for single rows is not. The loss of EdgeNoise
/// is inside, so that one event of a pair may be an outlier. Parameters: both nodes, the edge.
class EventPairCost
    : public ceres::SizedCostFunction<2, NodeCorrection::kSize, NodeCorrection::kSize, 4> {
 public:
  /// `weights`: 1 / sigma [1/px] of each; 0: no event. `camera` outlives this.
  EventPairCost(const std::array<ObservedEvent, 2>& events, const std::array<double, 2>& weights,
                const PinholeCamera& camera)
      : events_(events), weights_(weights), camera_(camera) {}

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    const Eigen::Map<const Twist> before(parameters[0]), after(parameters[1]);
    const Eigen::Map<const EdgeUnknowns> edge(parameters[2]);
    for (std::size_t row = 0; row < 2; ++row) {
      const double weight = weights_[row], s = events_[row].fraction;
      EdgeDerivatives by;
      const double residual =
          edge_residual(events_[row].observation, camera_, (1 - s) * before + s * after, edge,
                        jacobians != nullptr ? &by : nullptr);
      if (!std::isfinite(residual)) return false;
      const auto [value, slope] = cauchy_residual(weight * residual, EdgeNoise::kCauchyScale);
      residuals[row] = value;
      if (jacobians == nullptr) continue;
      const double scale = weight * slope;
      for (std::size_t node = 0; node < 2; ++node)
        if (jacobians[node] != nullptr)
          write_block(jacobians[node] + row * 6, scale * (node == 0 ? 1 - s : s) * by.motion);
      if (jacobians[2] != nullptr) write_block(jacobians[2] + row * 4, scale * by.edge);
    }
    return true;
  }

 private:
  std::array<ObservedEvent, 2> events_;
  std::array<double, 2> weights_;
  const PinholeCamera& camera_;
};

}  // namespace saccade
