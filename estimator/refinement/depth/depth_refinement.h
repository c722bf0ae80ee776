#pragma once

#include <cstddef>
#include <span>

#include "core/camera.h"
#include "estimator/depth/rays/ray_depth.h"

namespace saccade {

struct RefinedDepth {
  DepthResult result;      ///< fused, as `saccade run depth` fuses
  std::size_t edges = 0;   ///< that were adjusted
  double cost_before = 0;  ///< sum over the edges
  double cost_after = 0;
};

/// The optimum of every edge's inverse depth, offset, tilt and hysteresis over all of the window's
/// events that are its own (edge_residual.h, edge_noise.h), poses fixed, by Ceres; the sigma of the
/// depth is that of its covariance. `start`: a run's points in the window's view; edges near them
/// are kept and begin there. `depth` finds and fuses the edges. Deterministic; thread-safe.
[[nodiscard]] RefinedDepth refine_depth_of(const ViewWindow& window,
                                           std::span<const EdgePoint> start,
                                           const PinholeCamera& camera, const RayDepth& depth);

}  // namespace saccade
