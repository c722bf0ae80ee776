#pragma once

#include <vector>

#include "core/camera.h"
#include "estimator/depth/depth_estimator.h"
#include "estimator/depth/edge_seeds.h"
#include "estimator/depth/event_ownership.h"
#include "estimator/depth/event_rays.h"
#include "estimator/depth/planar_fusion.h"
#include "estimator/depth/ray_regression.h"

namespace saccade {

struct RayDepthOptions {
  int slabs = 32;  ///< parts of the window's time in which events are looked up by place
  SeedOptions seeds;
  double spacing_px = 0.8;  ///< between edges at the same depth, at least
  RegressionOptions regression;
  double max_residual_px = 0.8;  ///< deviation of an edge's events from it
  double max_sigma = 0.015;      ///< of the inverse depth, relative; edges with more are dropped
  OwnershipOptions ownership;
  FusionOptions fusion;
};

/// Depth of edges from the rays of all events at once. No reference image: seeds come from a space
/// sweep, and each seed's inverse depth from a regression over the rays that pass near it, first
/// those near the reference time, then, as the depth gets better, over the whole window.
class RayDepth : public DepthEstimator {
 public:
  RayDepth(const RayDepthOptions& options, const DepthLimits& limits, const PinholeCamera& camera);

  [[nodiscard]] DepthResult estimate(const DepthWindow& window) const override;

 private:
  [[nodiscard]] std::vector<FittedEdge> fit(const EventRays& rays,
                                            const std::vector<EdgeSeed>& seeds,
                                            EdgeEvents& events) const;

  RayDepthOptions options_;
  DepthLimits limits_;
  PinholeCamera camera_;  ///< undistorted
  UndistortionTable undistortion_;
};

}  // namespace saccade
