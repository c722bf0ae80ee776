#pragma once

#include <limits>
#include <span>

#include "core/camera.h"
#include "core/trajectory.h"
#include "estimator/depth/rays/ray_depth.h"
#include "estimator/edges/edge_fit.h"
#include "estimator/edges/landmarks.h"
#include "estimator/edges/least_squares/edge_bundle.h"
#include "estimator/run/view_windows.h"

namespace saccade {

struct WindowAdjustmentOptions {
  /// What the sigmas of nodes are of: image motion, so that a translation and the rotation that
  /// looks like it may go together, or each translation and rotation by itself.
  enum class PriorOf { kImageMotion, kPose };

  double node_spacing_s = 0.02;  ///< the correction of the poses is linear between nodes
  int edges = 800;               ///< at most so many, evenly chosen
  /// Of an edge's events between two nodes at most one pair enters and, while the poses are given, so
  /// many, evenly in time: only there events determine the scale.
  int given_pairs = 5;
  int iterations = 10;  ///< of Levenberg-Marquardt, at most
  /// All edges are fitted to the corrected path; false leaves that to edges_on_path(), on a path that
  /// is corrected further.
  bool fits_edges = true;
  BundleSolver solver = BundleSolver::kStructured;
  /// Sigmas of a node from the given path and, tighter, from its neighbours.
  PriorOf prior_of = PriorOf::kImageMotion;
  double pose_sigma_px = 1;          ///< as image motion
  double smoothness_sigma_px = 0.1;  ///< between neighbouring nodes
  double fixed_sigma_px = 0.02;      ///< of poses before the active window
  double rotation_sigma_ratio = 1;   ///< of kPose: on rotations, where a gyroscope measures them
  /// Of the edges from a smooth surface (CoarseSurface), relative to the typical inverse depth; 0:
  /// edges are independent.
  double surface_sigma = 0;
  double surface_spacing_px = 15;  ///< of the surface's nodes
  /// A ParallaxPrior, where something holds the scale. Starts by a gyroscope have none.
  bool has_parallax_prior = true;
};

/// A time before all others.
inline constexpr double kNoGivenPoses = std::numeric_limits<double>::lowest();

/// What is known before the window's events.
struct WindowPriors {
  double fixed_until_s = 0;              ///< poses until then are fixed; the active window begins
  double given_until_s = kNoGivenPoses;  ///< those until then are exact
  double typical_depth_m = 1;
  std::span<const Landmark> landmarks;
};

struct WindowAdjustment {
  Trajectory trajectory;  ///< the path of before, corrected
  WindowEdgels
      edges;  ///< all of those given that still fit, in the view's corrected pose; or as given
  double residual_before_px = 0;  ///< robust standard deviation of the events
  double residual_after_px = 0;
  bool ok = false;  ///< false: too little to adjust; nothing is changed
};

/// Bundle adjustment over a sliding window (Triggs et al., 2000), edges in place of points: a
/// NodeCorrection of the path, and of every edge the inverse depth, offset, tilt and hysteresis. It
/// minimises the residual of edge_residual.h with the noise model of edge_noise.h as an EdgeBundle.
/// What the freedom of all these depths adds to the path's parallax is taken out where poses are
/// given or edges lie on a surface (ParallaxPrior). The fixed poses and the landmarks on which edges
/// lie constrain the gauge. All edges are then fitted to the corrected path one by one.
/// Deterministic for any number of threads.
[[nodiscard]] WindowAdjustment adjust_window(const ViewWindow& window, const WindowEdgels& edges,
                                             const PinholeCamera& camera,
                                             const WindowPriors& priors,
                                             const WindowAdjustmentOptions& options);

/// The edges of a window that still fit, each fitted by itself to the window's path as it is.
[[nodiscard]] WindowEdgels edges_on_path(const ViewWindow& window, const WindowEdgels& edges,
                                         const PinholeCamera& camera, const WindowPriors& priors,
                                         const WindowAdjustmentOptions& options);

}  // namespace saccade
