#pragma once

#include <ceres/sized_cost_function.h>

#include "core/camera.h"
#include "estimator/refinement/edge_residual.h"
#include "estimator/refinement/path_correction.h"

namespace saccade {

/// The unknowns of an edge (edge_residual.h) and, last, k [px]: how far further in each event of a
/// run (event_steps.h) lies than the one before. h is of the polarity alone.
using SteppedEdge = Eigen::Matrix<double, 5, 1>;

/// One event against an edge of a keyframe (edge_residual.h), by the four twists of the path's
/// correction at its time and the edge's unknowns: the offset is c + k `step`.
class PathEdgeCost
    : public ceres::SizedCostFunction<1, PathCorrection::kSize, PathCorrection::kSize,
                                      PathCorrection::kSize, PathCorrection::kSize, 5> {
 public:
  PathEdgeCost(const EdgeObservation& observation, double step, const PinholeCamera& camera,
               const Eigen::Vector4d& weight, double sigma_px)
      : observation_(observation),
        step_(step),
        camera_(camera),
        weight_(weight),
        sigma_px_(sigma_px) {}

  /// False where the ray leads away from the keyframe's view.
  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  EdgeObservation observation_;
  double step_;
  PinholeCamera camera_;
  Eigen::Vector4d weight_;
  double sigma_px_;
};

/// A pose that is known: (xi(t) + given) / sigma, `given` the twist of known^-1 given path.
class KnownPoseCost : public ceres::SizedCostFunction<PathCorrection::kSize, PathCorrection::kSize,
                                                      PathCorrection::kSize, PathCorrection::kSize,
                                                      PathCorrection::kSize> {
 public:
  KnownPoseCost(const Twist& given, const Eigen::Vector4d& weight, const Twist& sigma)
      : given_(given), weight_(weight), precision_(sigma.cwiseInverse()) {}

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  Twist given_;
  Eigen::Vector4d weight_;
  Twist precision_;
};

}  // namespace saccade
