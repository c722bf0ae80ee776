#include "estimator/tracking/pose_solver.h"

#include "estimator/tracking/cholesky.h"

namespace saccade {

PoseSolver::PoseSolver(const PosePrediction& predicted, double information)
    : information_(information),
      prior_(predicted.precision / information),
      map_from_camera_(predicted.map_from_camera) {}

bool PoseSolver::step(const PoseEquations& equations) {
  Cholesky<6> factors;
  if (!factors.factor(equations.normal + prior_)) return false;
  const Twist step = factors.solve(equations.rhs - prior_ * error_);
  if (!step.allFinite()) return false;
  map_from_camera_ = map_from_camera_ * Rigid3::exp(step);
  error_ += step;
  return true;
}

Matrix6 PoseSolver::information(const PoseEquations& equations) const {
  return information_ * Matrix6(equations.normal.selfadjointView<Eigen::Upper>());
}

}  // namespace saccade
