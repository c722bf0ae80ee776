#pragma once

#include <cstddef>
#include <span>

#include "core/camera.h"
#include "core/event.h"
#include "core/trajectory.h"
#include "estimator/depth/rays/ray_depth.h"
#include "estimator/edges/window/window_adjustment.h"
#include "estimator/tracking/gyroscope.h"

namespace saccade {

struct PathRefinementOptions {
  std::size_t min_edges = 100;
  /// Of a free path: where fewer have a depth that can be told, as where the camera rotates more than
  /// it translates, others near the typical depth are adjusted, too.
  std::size_t enough_edges = 0;
  RayDepthOptions rays;
  DepthLimits limits{.near_m = 0.3, .far_m = 50};  ///< of a free path the typical depth is 1
  WindowAdjustmentOptions adjustment;
};

/// The refinement of a start by default: weak priors on the path, edges on a smooth surface.
[[nodiscard]] PathRefinementOptions start_refinement();
/// The same with tight priors on rotations, where a gyroscope measures them: it is not empty.
[[nodiscard]] PathRefinementOptions measuring_rotation(PathRefinementOptions options,
                                                       const Gyroscope& gyroscope);

/// A path that is known up to a similarity, or from its given poses on.
struct FreePath {
  Trajectory poses;        ///< world_from_camera; of a free one the typical depth is 1
  std::size_t edges = 0;   ///< found with it
  std::size_t events = 0;  ///< of theirs
  double residual_px = 0;  ///< robust standard deviation of these
  bool is_clear = false;   ///< there were enough edges in every round
};

/// Path and edges of a start's window (not the module `refine`), adjusted alternately: edges are
/// found with the path (RayDepth), then both are adjusted (window_adjustment.h). Of a path without
/// given poses no pose is fixed, and the typical depth stays the unit of length.
class PathRefinement {
 public:
  PathRefinement(const PathRefinementOptions& options, const PinholeCamera& camera);

  /// `events` of the window, at least one, none beyond `path`; `rounds` of finding edges and
  /// adjusting them with the path, whose nodes until `given_until_s` are fixed.
  [[nodiscard]] FreePath refine(std::span<const Event> events, const Trajectory& path, int rounds,
                                double given_until_s = kNoGivenPoses) const;

 private:
  PathRefinementOptions options_;
  PinholeCamera camera_;
  RayDepth depth_;
  RayDepth assuming_;  ///< with edges of an assumed depth
};

}  // namespace saccade
