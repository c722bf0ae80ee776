#include "estimator/edges/batch/path_edge_cost.h"

#include <cmath>

#include "estimator/edges/least_squares/jacobian_block.h"

namespace saccade {

bool PathEdgeCost::Evaluate(double const* const* parameters, double* residuals,
                            double** jacobians) const {
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

}  // namespace saccade
