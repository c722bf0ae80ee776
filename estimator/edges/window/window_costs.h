#pragma once

#include <array>
#include <utility>

#include <ceres/sized_cost_function.h>

#include "core/camera.h"
#include "core/rigid3.h"
#include "estimator/edges/edge_residual.h"
#include "estimator/edges/window/node_correction.h"

namespace saccade {

/// A root W of the information about a twist (v, w) of a camera whose image is known to move by
/// `sigma_px`, RMS, whatever is in view at half to twice the depth:
///   W^T W = mean over pixels and depths of J^T J / sigma^2,  J the image motion of the twist
/// (Longuet-Higgins and Prazdny, 1980). Motions that look alike are hardly distinguished.
[[nodiscard]] Matrix6 image_motion_sqrt_information(const PinholeCamera& camera, double depth_m,
                                                    double sigma_px);

/// What a Cauchy loss a^2 ln(1 + (r/a)^2) makes of a residual r: r' with r'^2 the loss, and dr'/dr.
[[nodiscard]] std::pair<double, double> cauchy_residual(double residual, double scale);

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
                double** jacobians) const override;

 private:
  std::array<ObservedEvent, 2> events_;
  std::array<double, 2> weights_;
  const PinholeCamera& camera_;
};

}  // namespace saccade
