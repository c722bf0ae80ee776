#pragma once

#include <limits>
#include <span>

#include "core/camera.h"
#include "core/trajectory.h"
#include "estimator/depth/rays/ray_depth.h"
#include "estimator/refinement/landmarks.h"
#include "estimator/run/view_windows.h"

namespace saccade {

struct AdjustmentOptions {
  /// What the deviations of nodes are about: the picture's motion, so that a step and the turn that
  /// looks like it may go together, or each step and turn by itself.
  enum class Deviations { kPicture, kPose };

  double node_spacing_s = 0.04;  ///< the correction of the poses is linear between nodes
  int edges = 1000;              ///< at most so many, evenly chosen
  int pairs = 1;                 ///< of an edge's events between two nodes, at most, evenly in time
  /// The same where the poses are given: there events tell the scale, so that more of them count.
  int given_pairs = 1;
  double noise_px = 0.1;  ///< least deviation of an event from its edge
  double outlier = 2;     ///< deviations beyond which it counts less (Cauchy)
  int iterations = 10;    ///< of Levenberg-Marquardt, at most
  /// What is assumed of an edge's unknowns; of its inverse depth hardly anything.
  double offset_px = 2;        ///< of c from 0
  double tilt_sigma = 0.3;     ///< of m from 0
  double hysteresis_px = 0.5;  ///< of h from 0
  /// What an edge is off by from the landmark that it lies on; 0: landmarks hold nothing.
  double landmark_px = 0.3;      ///< across the edge
  double landmark_depth = 0.01;  ///< relative, beside the landmark's own
  /// What the poses are off by: of a node from what was assumed and, looser, between neighbours.
  Deviations deviations = Deviations::kPicture;
  double pose_sigma_px = 3;      ///< as image motion
  double step_sigma_px = 0.3;    ///< between neighbouring nodes
  double known_sigma_px = 0.05;  ///< of poses that are known already
  double turn_share = 1;  ///< of kPose: of turns, from these, where something else tells them
  /// Of the edges from a smooth surface (CoarseSurface), relative to the typical inverse depth; 0:
  /// edges are on their own.
  double surface_sigma = 0;
  double surface_spacing_px = 15;  ///< of the surface's nodes
};

/// A time before all others.
inline constexpr double kNothingGiven = std::numeric_limits<double>::lowest();

/// What is known beside the window.
struct KnownScene {
  double until_s = 0;                    ///< the poses until then
  double given_until_s = kNothingGiven;  ///< those until then are exact
  double typical_depth_m = 1;
  std::span<const Landmark> landmarks;
};

/// What the adjustment found.
struct Adjustment {
  Trajectory trajectory;  ///< the poses given, corrected
  WindowEdgels edges;     ///< all of those given that still fit, in the view's corrected pose
  double residual_before_px = 0;  ///< robust deviation of the events
  double residual_after_px = 0;
  bool ok = false;  ///< false: too little to adjust; nothing is changed
};

/// Bundle adjustment over a window (Triggs et al., 2000), events against edges: a NodeCorrection,
/// and of every edge the inverse depth, offset, tilt and hysteresis, minimising the residuals of
/// edge_residual.h robustly, by Ceres with the edges eliminated first (Schur). Scale and place are
/// held by the poses that are known and by the landmarks that edges lie on. All edges are then
/// fitted to the corrected path one by one. Deterministic; one thread.
[[nodiscard]] Adjustment adjust(const ViewWindow& window, const WindowEdgels& edges,
                                const PinholeCamera& camera, const KnownScene& known,
                                const AdjustmentOptions& options);

}  // namespace saccade
