#pragma once

#include "core/rigid3.h"
#include "estimator/tracking/cholesky.h"
#include "estimator/tracking/motion_model.h"

namespace saccade {

/// Normal equations of a robust least-squares step over a small motion T <- T exp(xi^) of the
/// camera: what batches of residuals sum up to.
struct PoseEquations {
  Matrix6 normal = Matrix6::Zero();  ///< J^T W J, upper triangle
  Twist rhs = Twist::Zero();         ///< J^T W r
};

/// The outcome of one alignment; `sums` extend the PoseEquations at the pose by their evidence.
template <class Sums>
struct PoseEstimate {
  Rigid3 map_from_camera;
  Matrix6 information = Matrix6::Zero();  ///< by the residuals alone
  Sums sums;
  bool is_valid = false;
};

/// Gauss-Newton on SE(3) for a pose that residuals and a prediction determine together: with e the
/// sum of the steps so far, P the covariance of the prediction and k the information of a residual
/// of weight one, each step solves
///   (J^T W J + P^-1 / k) xi = J^T W r - (P^-1 / k) e,   T <- T exp(xi^).
class PoseSolver {
 public:
  /// Begins at the prediction. `information` > 0: k.
  PoseSolver(const PosePrediction& predicted, double information);

  /// False, and no step, where the equations are singular.
  [[nodiscard]] bool step(const PoseEquations& equations);

  [[nodiscard]] const Rigid3& map_from_camera() const { return map_from_camera_; }
  /// Inverse covariance of the pose by the residuals alone, both triangles.
  [[nodiscard]] Matrix6 information(const PoseEquations& equations) const;

 private:
  double information_;
  Matrix6 prior_;  ///< P^-1 / k
  Rigid3 map_from_camera_;
  Twist error_ = Twist::Zero();  ///< from the prediction
};

inline PoseSolver::PoseSolver(const PosePrediction& predicted, double information)
    : information_(information),
      prior_(predicted.precision / information),
      map_from_camera_(predicted.map_from_camera) {}

inline bool PoseSolver::step(const PoseEquations& equations) {
  Cholesky<6> factors;
  if (!factors.factor(equations.normal + prior_)) return false;
  const Twist step = factors.solve(equations.rhs - prior_ * error_);
  if (!step.allFinite()) return false;
  map_from_camera_ = map_from_camera_ * Rigid3::exp(step);
  error_ += step;
  return true;
}

inline Matrix6 PoseSolver::information(const PoseEquations& equations) const {
  return information_ * Matrix6(equations.normal.selfadjointView<Eigen::Upper>());
}

}  // namespace saccade
