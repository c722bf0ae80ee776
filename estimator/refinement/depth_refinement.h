#pragma once

#include <cstddef>
#include <span>

#include "core/camera.h"
#include "estimator/depth/rays/ray_depth.h"

namespace saccade {

struct DepthRefinementOptions {
  double reach_px = 2;          ///< events so near to an edge, across it, are looked at
  double half_length_px = 1.5;  ///< ... and along it
  double near_px = 1.5;         ///< an edge is that of a point of the run within so much of it
  double same_depth = 0.05;     ///< ... and within this share of its inverse depth
  double noise_px = 0.1;        ///< least deviation of an event from its edge
  double outlier = 2;           ///< deviations beyond which an event counts less (Cauchy)
  double tilt_sigma = 0.3;      ///< of an edge's tilt m from 0
  double hysteresis_px = 0.5;   ///< of h from 0
  double offset_px = 2;         ///< of c from 0
  int iterations = 20;          ///< of Levenberg-Marquardt, at most
  double information = 0.3;     ///< of that of independent residuals: neighbouring ones err alike
};

struct RefinedDepth {
  DepthResult result;      ///< fused, as `saccade run depth` fuses
  std::size_t edges = 0;   ///< that were adjusted
  double cost_before = 0;  ///< sum over the edges
  double cost_after = 0;
};

/// The optimum of every edge's inverse depth, offset, tilt and hysteresis over all events of the
/// window that pass near it (edge_residual.h), poses held, by Ceres; the deviation of the depth is
/// that of its covariance. `start`: a run's points in the window's view, where edges are kept and
/// begin. `depth` finds and fuses the edges. Deterministic; thread-safe.
[[nodiscard]] RefinedDepth refine_depth_of(const ViewWindow& window,
                                           std::span<const EdgePoint> start,
                                           const PinholeCamera& camera, const RayDepth& depth,
                                           int slabs, const DepthRefinementOptions& options);

}  // namespace saccade
