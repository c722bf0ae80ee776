#pragma once

#include <span>

#include "core/spline/knots.h"
#include "estimator/edges/least_squares/cost_log.h"
#include "estimator/refinement/poses/event_run_observations.h"
#include "estimator/refinement/poses/increment_images.h"
#include "estimator/refinement/poses/map_surface.h"
#include "estimator/refinement/poses/path_problem.h"

namespace saccade {

struct PoseRefinementOptions {
  /// What is compared with the map: the log intensity at single events, or increments over many.
  enum class Residual { kEvents, kFrames };

  Residual residual = Residual::kEvents;
  double knot_spacing_s = 0.05;  ///< of the path's cubic spline
  int events = 200000;           ///< of kEvents: about so many at most, of evenly spread pixels
  int run_events =
      1000;  ///< events of a run that share one offset: longer runs drift apart on a real sensor
  int increments = 1000000;  ///< of kFrames: about so many at most, of evenly spread pixels
  int window_events = 5000;  ///< of kFrames: in a window
  int rounds = 2;            ///< of finding the surface that each residual samples, and adjusting
  double log_intensity_sigma = 0.05;   ///< of an observation from the map [log units]
  double reprojection_sigma_px = 0.2;  ///< of the pixel where the map shows it

  /// Cauchy's loss, in sigmas. The rounding of an increment to whole thresholds is no outlier:
  /// where it counts as one, the many increments of 0 slow the path down.
  static constexpr double kCauchyScaleOfEvents = 0.5;
  static constexpr double kCauchyScaleOfFrames = 3;
  /// Sigma of the control poses about the tracked path, as image motion: next to nothing, for where
  /// no event constrains them.
  static constexpr double kPathSigma_px = 30;
  static constexpr int kIterations = 6;  ///< of Levenberg-Marquardt in a round, at most
  /// Motion of the view after which the map is drawn anew: half a pixel finds the same surfaces.
  static constexpr double kRedraw_px = 0.5;
  /// Of that of independent residuals: the errors of a picture of point samples are alike for
  /// neighbouring events.
  static constexpr double kInformationRatio = 0.1;
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
