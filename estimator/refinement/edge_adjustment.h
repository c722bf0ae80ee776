#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/camera.h"
#include "core/trajectory.h"
#include "estimator/depth/ray_depth.h"
#include "estimator/view_windows.h"

namespace saccade {

struct AdjustmentOptions {
  double node_spacing_s = 0.02;  ///< the correction of the poses is linear between nodes
  int edges = 1500;              ///< at most so many, evenly chosen
  int events_per_edge = 40;      ///< at most, evenly in time
  double noise_px = 0.1;         ///< least deviation of an event from its edge
  double outlier = 2;            ///< deviations beyond which it counts less (Cauchy)
  int iterations = 10;           ///< of Levenberg-Marquardt, at most
  double tilt_sigma = 0.3;       ///< of an edge's tilt m from 0
  double hysteresis_px = 0.5;    ///< of h from 0
  double offset_px = 2;          ///< of c from 0
  /// What the poses are off by: of a node from what was assumed and, looser, between neighbours.
  double pose_sigma_px = 3;      ///< as image motion
  double step_sigma_px = 0.3;    ///< between neighbouring nodes
  double known_sigma_px = 0.05;  ///< of poses that are known already
};

/// What the adjustment found.
struct Adjustment {
  Trajectory trajectory;          ///< the poses given, corrected
  RayEdges edges;                 ///< corrected: pixel, normal, inverse depth and its deviation
  double residual_before_px = 0;  ///< robust deviation of the events
  double residual_after_px = 0;
  int iterations = 0;
  bool ok = false;  ///< false: too little to adjust; nothing is changed
};

/// Bundle adjustment over a window (Triggs et al., 2000), events against edges: a correction of the
/// camera's path, linear between nodes on SE(3),
///   world_from_camera(t) = given(t) exp((1 - s) xi_j + s xi_(j+1)),
/// and of every edge the inverse depth, offset, tilt and hysteresis, minimising the residuals of
/// edge_residual.h robustly, by Ceres with the edges eliminated first (Schur). The edges stay in
/// their view, whose pose is a mere frame; scale and place are held by the poses up to
/// `known_until_s`. `typical_depth_m` turns pixels into metres. Deterministic; one thread.
[[nodiscard]] Adjustment adjust(const ViewWindow& window, const RayEdges& edges,
                                const PinholeCamera& camera, double known_until_s,
                                double typical_depth_m, const AdjustmentOptions& options);

}  // namespace saccade
