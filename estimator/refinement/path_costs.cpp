#include "estimator/refinement/path_costs.h"

#include <cmath>

#include "estimator/refinement/jacobian_block.h"

namespace saccade {
namespace {

Twist blended(double const* const* parameters, const Eigen::Vector4d& weight) {
  Twist twist = Twist::Zero();
  for (int k = 0; k < 4; ++k) twist += weight[k] * Eigen::Map<const Twist>(parameters[k]);
  return twist;
}

}  // namespace

bool PathEdgeCost::Evaluate(double const* const* parameters, double* residuals,
                            double** jacobians) const {
  const Eigen::Map<const SteppedEdge> stepped(parameters[4]);
  EdgeUnknowns edge = stepped.head<4>();
  edge[1] += step_ * stepped[4];
  EdgeDerivatives by;
  residuals[0] = edge_residual(observation_, camera_, blended(parameters, weight_), edge,
                               jacobians != nullptr ? &by : nullptr) /
                 sigma_px_;
  if (!std::isfinite(residuals[0])) return false;
  if (jacobians == nullptr) return true;
  for (int k = 0; k < 4; ++k) write_block(jacobians[k], weight_[k] / sigma_px_ * by.motion);
  Eigen::Matrix<double, 1, 5> by_stepped;
  by_stepped << by.edge, step_ * by.edge[1];
  write_block(jacobians[4], by_stepped / sigma_px_);
  return true;
}

bool KnownPoseCost::Evaluate(double const* const* parameters, double* residuals,
                             double** jacobians) const {
  Eigen::Map<Twist>(residuals, PathCorrection::kSize) =
      precision_.cwiseProduct(blended(parameters, weight_) + given_);
  if (jacobians == nullptr) return true;
  for (int k = 0; k < 4; ++k)
    write_block(jacobians[k], Matrix6((weight_[k] * precision_).asDiagonal()));
  return true;
}

}  // namespace saccade
