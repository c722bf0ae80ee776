#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/spline/knots.h"
#include "estimator/refinement/cost_log.h"
#include "estimator/refinement/increment_images.h"
#include "estimator/refinement/level_chains.h"
#include "estimator/refinement/map_surface.h"
#include "estimator/refinement/path_problem.h"

namespace saccade {

struct PoseRefinementOptions {
  /// What is compared with the map: the levels of single events, or images of many.
  enum class Residual { kEvents, kFrames };

  Residual residual = Residual::kEvents;
  double knot_spacing_s = 0.05;  ///< of the path
  ChainOptions chains;           ///< of kEvents
  IncrementOptions images;       ///< of kFrames
  double noise = 0.05;           ///< deviation of a level from the map [log units]
  double place_px = 0.2;         ///< of the place where the map shows it
  double outlier = 0.5;          ///< of kEvents: deviations beyond which one counts less (Cauchy)
  double hold_px = 30;           ///< of the control poses from where they were, as image motion
  int rounds = 2;                ///< of finding the surface that each residual saw, and adjusting
  int iterations = 6;            ///< of Levenberg-Marquardt in a round, at most
  double redraw_px = 0.5;        ///< the map is drawn anew when the view has moved this far
  double information = 0.1;      ///< of that of independent residuals: neighbouring ones err alike
};

/// The path that fits best, and how surely.
struct RefinedPath : PathEvidence {
  SplineControls map_from_camera;
  CostLog costs;

  /// Of the pose at a time: the twist (v, w) in the camera's axes. 0 where it is not determined.
  [[nodiscard]] Matrix6 covariance_at(double t_s) const;
};

/// The batch optimum of the camera's path before a known map: a cubic spline whose control poses
/// are adjusted to all events at once, by Ceres. `start` is the path as a tracker found it, within
/// a pixel or two; it spans the events. Deterministic; one thread.
[[nodiscard]] RefinedPath refine_path(const MapSurface& surface, const PinholeCamera& camera,
                                      const EventContrast& contrast, std::span<const Event> events,
                                      std::span<const StampedPose> start,
                                      const PoseRefinementOptions& options);

}  // namespace saccade
