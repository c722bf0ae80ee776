#pragma once

#include <ceres/sized_cost_function.h>
#include <cmath>

#include "core/camera.h"
#include "estimator/edges/batch/path_correction.h"
#include "estimator/edges/edge_residual.h"
#include "estimator/edges/least_squares/jacobian_block.h"

namespace saccade {

/// The unknowns of an edge (edge_residual.h) and, last, k [px]: how much farther across the
/// edge each event of a polarity run (polarity_runs.h) lies than the one before. h, the ON/OFF shift, is
/// of the polarity alone.
using BatchEdgeUnknowns = Eigen::Matrix<double, 5, 1>;

/// One event against an edge of a keyframe (edge_residual.h) over its sigma (edge_noise.h), by the
/// four twists of the path's correction at its time and the edge's unknowns: the offset is
///   c + k p (j - mean j),
/// j the event's position in its polarity run.
class PathEdgeCost
    : public ceres::SizedCostFunction<1, PathCorrection::kSize, PathCorrection::kSize,
                                      PathCorrection::kSize, PathCorrection::kSize, 5> {
 public:
  /// `run_offset`: p (j - mean j).
  PathEdgeCost(const EdgeObservation& observation, double run_offset, const PinholeCamera& camera,
               const Eigen::Vector4d& weight, double sigma_px)
      : observation_(observation),
        run_offset_(run_offset),
        camera_(camera),
        weight_(weight),
        sigma_px_(sigma_px) {}

  /// False where the ray leads away from the keyframe's view.
  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    const Eigen::Map<const BatchEdgeUnknowns> unknowns(parameters[4]);
    EdgeUnknowns edge = unknowns.head<4>();
    edge[1] += run_offset_ * unknowns[4];
    Twist twist = Twist::Zero();
    for (int k = 0; k < 4; ++k) twist += weight_[k] * Eigen::Map<const Twist>(parameters[k]);
    EdgeDerivatives by;
    residuals[0] =
        edge_residual(observation_, camera_, twist, edge, jacobians != nullptr ? &by : nullptr) /
        sigma_px_;
    if (!std::isfinite(residuals[0])) return false;
    if (jacobians == nullptr) return true;
    for (int k = 0; k < 4; ++k) write_block(jacobians[k], weight_[k] / sigma_px_ * by.motion);
    Eigen::Matrix<double, 1, 5> by_unknowns;
    by_unknowns << by.edge, run_offset_ * by.edge[1];
    write_block(jacobians[4], by_unknowns / sigma_px_);
    return true;
  }

 private:
  EdgeObservation observation_;
  double run_offset_;
  PinholeCamera camera_;
  Eigen::Vector4d weight_;
  double sigma_px_;
};

}  // namespace saccade
