#pragma once

#include <cstddef>
#include <span>

#include "core/camera.h"
#include "core/event.h"
#include "core/trajectory.h"
#include "estimator/depth/ray_depth.h"
#include "estimator/refinement/edge_adjustment.h"

namespace saccade {

struct PathRefinementOptions {
  std::size_t min_edges = 100;
  RayDepthOptions rays;
  DepthLimits limits{.near_m = 0.3, .far_m = 50};  ///< the typical depth being 1
  AdjustmentOptions adjustment;
};

/// A path that is known up to a similarity.
struct FreePath {
  Trajectory poses;        ///< world_from_camera; the typical depth is 1
  std::size_t edges = 0;   ///< found with it
  std::size_t events = 0;  ///< of theirs
  double residual_px = 0;  ///< robust deviation of these
  bool is_clear = false;   ///< there were enough edges in every round
};

/// Path and edges of a window, adjusted in turn: edges are found with the path (RayDepth), then
/// both are adjusted (edge_adjustment.h) with nothing held. The typical depth stays the unit of
/// length.
class PathRefinement {
 public:
  PathRefinement(const PathRefinementOptions& options, const PinholeCamera& camera);

  /// `events` of the window, at least one, none beyond `path`; `rounds` of finding edges and
  /// adjusting them with the path.
  [[nodiscard]] FreePath refine(std::span<const Event> events, const Trajectory& path,
                                int rounds) const;

 private:
  PathRefinementOptions options_;
  PinholeCamera camera_;
  RayDepth depth_;
};

}  // namespace saccade
