#pragma once

#include <cstddef>
#include <vector>

#include "core/camera.h"
#include "core/rigid3.h"
#include "eval/information/true_edges.h"

namespace saccade {

/// A pose of the path, on its own in the estimate.
struct PathNode {
  double t_s = 0;
  Rigid3 world_from_camera;
  double motion_px = 0;  ///< of the view since the node before, in the median
};

/// Poses between which the view moves by two pixels, in the median over the edges that both see (what
/// both see none of is taken for as far away as `depth_m`), or by more where that makes more than 200
/// of them. The recording's first pose is the first; where nothing moves by as much the last is the
/// second.
[[nodiscard]] std::vector<PathNode> path_nodes(const Trajectory& path, const TrueEdges& edges,
                                               const PinholeCamera& camera, double depth_m);

/// Where an edge is across its own line, as the events between two nodes tell it at the second:
///   e = n^T pi(world_from_camera^-1 point)  [px],
/// with n the unit normal of the line in the image. The point is taken for its first order about
/// the truth, point + per_log_z dz + per_px dp.
struct LineObservation {
  std::size_t node = 0;
  Eigen::Matrix<double, 1, 6> by_pose;  ///< for world_from_camera exp(xi^) [px]
  Eigen::RowVector2d by_edge;           ///< for (dz, dp) [px]
  double weight = 0;                    ///< 1 / sigma^2 [1/px^2]
};

/// d e / d xi and d e / d (dz, dp), see LineObservation; `weight` is left at 0.
[[nodiscard]] LineObservation linearise(const PinholeCamera& camera, const TrueEdge& edge,
                                        const Rigid3& world_from_camera);

/// The observations of one edge in the order of the nodes. `contrast`: threshold [log units].
[[nodiscard]] std::vector<LineObservation> observe(const PinholeCamera& camera,
                                                   const TrueEdges& edges, const TrueEdge& edge,
                                                   const std::vector<PathNode>& nodes,
                                                   double contrast);

}  // namespace saccade
