#pragma once

#include <array>

#include <Eigen/Core>

#include <ceres/sized_cost_function.h>

#include "core/camera.h"
#include "core/rigid3.h"
#include "estimator/refinement/edge_residual.h"
#include "estimator/refinement/node_correction.h"

namespace saccade {

/// A root W of the information about a twist (v, w) of a camera whose image is known to move by
/// `sigma_px` at most, whatever it sees at half to twice the depth: motions that look alike are
/// told apart by little.
[[nodiscard]] Matrix6 image_motion_root(const PinholeCamera& camera, double depth_m,
                                        double sigma_px);

/// What a Cauchy loss a^2 ln(1 + (r/a)^2) makes of a residual: r' with r'^2 the loss, and dr'/dr.
struct SoftResidual {
  double value;
  double slope;
};
[[nodiscard]] SoftResidual soft(double residual, double scale);

/// An event between two nodes of a path's correction.
struct WeighedEvent {
  EdgeObservation observation;
  double share = 0;   ///< of the later node
  double weight = 0;  ///< 1 / deviation [1/px]; 0: no event
};

/// Two events of one edge between the same two nodes: a pair, because of Ceres' Schur eliminators
/// the one for rows of two with blocks of four and six is compiled for these sizes, and that for
/// single rows is not. The loss is inside, so that one event of a pair may be an outlier.
/// Parameters: both nodes, the edge.
class EventPairCost
    : public ceres::SizedCostFunction<2, NodeCorrection::kSize, NodeCorrection::kSize, 4> {
 public:
  EventPairCost(const std::array<WeighedEvent, 2>& events, const PinholeCamera& camera,
                double outlier)
      : events_(events), camera_(camera), outlier_(outlier) {}

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  std::array<WeighedEvent, 2> events_;
  const PinholeCamera& camera_;
  double outlier_;
};

/// (x_k - mean_k) / sigma_k of two of an edge's unknowns; rows of two for the same reason.
class EdgePriorCost : public ceres::SizedCostFunction<2, 4> {
 public:
  EdgePriorCost(int first, const Eigen::Vector2d& mean, const Eigen::Vector2d& sigma)
      : first_(first), mean_(mean), precision_(sigma.cwiseInverse()) {}

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  int first_;
  Eigen::Vector2d mean_, precision_;
};

/// W xi of a node, W^T W the information.
class NodePriorCost
    : public ceres::SizedCostFunction<NodeCorrection::kSize, NodeCorrection::kSize> {
 public:
  explicit NodePriorCost(const Matrix6& root_of_information) : root_(root_of_information) {}

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  Matrix6 root_;
};

/// W (x_(j+1) - x_j) of six unknowns each, such as neighbouring nodes' twists.
class NodeStepCost : public ceres::SizedCostFunction<NodeCorrection::kSize, NodeCorrection::kSize,
                                                     NodeCorrection::kSize> {
 public:
  explicit NodeStepCost(const Matrix6& root_of_information) : root_(root_of_information) {}

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  Matrix6 root_;
};

}  // namespace saccade
