#pragma once

#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "core/camera.h"
#include "core/trajectory.h"
#include "estimator/depth/rays/ray_depth.h"
#include "estimator/edges/edge_view.h"
#include "estimator/edges/path/marginal_prior.h"
#include "estimator/edges/path/path_edge_problem.h"

namespace saccade {

struct FixedLagOptions {
  /// How far back views are adjusted together with the newest one [s]; 0: never.
  double lag_s = 0;
  /// Of a path of which nothing is known, as after the camera was lost, how long it is held at its
  /// beginning [s].
  double held_s = 0.2;
  double smoothing_s = 0.025;  ///< knots of the given path, as of BatchAdjustmentOptions
  int events_per_edge = 20;    ///< at most, evenly in time
  /// Beside them, while poses are given: they alone say how far away an edge is in metres.
  int given_events_per_edge = 100;
  /// How long before the newest view the edges of views are adjusted [s]. What older ones say of the
  /// path is known from then (MarginalPrior).
  double fresh_s = 0.65;
  /// Of these edges at most `edges` of each view. Two iterations will do: the next view goes on with
  /// what they leave. Edges are observed again by earlier views, whose own are not adjusted any
  /// more.
  /// The correction is as fast as what tracking by few events leaves: with knots 0.05 s apart, as of a
  /// whole path, the path kept errors of some hundredths of a second.
  PathEdgeProblemOptions problem{
      .knot_spacing_s = 0.02, .edges = 800, .reobserving = Reobserving::kEarlier, .iterations = 2};
};

/// Fixed-lag smoothing of a camera's path: whenever a view is added the path of the last seconds is
/// adjusted together with the edges of the newest views (PathEdgeProblem) and what is known of it
/// from older ones (MarginalPrior), so that edges that were seen from far apart constrain each
/// other. What is older is not changed any more: cost and memory do not grow with the path. Each
/// view's events belong to the edges that they belonged to when it was added.
class FixedLagSmoother {
 public:
  /// `camera` may have a lens.
  FixedLagSmoother(const FixedLagOptions& options, const PinholeCamera& camera)
      : options_(options), camera_(camera), known_(options.problem.knot_spacing_s) {}

  [[nodiscard]] bool is_enabled() const { return options_.lag_s > 0; }

  /// The view of a window that the smoother takes. `held_until_s`: poses until then do not change.
  [[nodiscard]] EdgeView view(const ViewWindow& window, const WindowEdgels& found,
                              double held_until_s) const;

  /// Adds the newest view. Those that have left the lag are forgotten, and those whose events it has,
  /// unless all of them are of given poses, those until `held_until_s`.
  void add(EdgeView newest, double held_until_s);
  /// Forgets all views, of a path that turned out to be wrong.
  void clear() {
    views_.clear();
    adjusted_views_ = 0;
    known_ = MarginalPrior(options_.problem.knot_spacing_s);
  }

  /// The poses of `path` from the lag's beginning to its end, adjusted with the edges of the views.
  /// Those until `held_until_s` stay as they are. nullopt: there is no view to adjust them by, or no
  /// solution. From call to call the path may change a little, but not become shorter.
  /// `landmarks`: edges known from before the lag, which stay where they are; where the camera
  /// returns to what it has seen they stop its drift.
  [[nodiscard]] std::optional<Trajectory> smooth(const Trajectory& path, double held_until_s,
                                                 double typical_depth_m,
                                                 std::span<const Landmark> landmarks = {});

 private:
  /// What views say that are not adjusted any more from now on.
  void take_over(PathEdgeProblem& problem);

  FixedLagOptions options_;
  PinholeCamera camera_;
  std::vector<EdgeView> views_;     ///< in order of time
  std::size_t adjusted_views_ = 0;  ///< of them the first, which are adjusted no more
  MarginalPrior known_;
  Trajectory path_;  ///< that it is about
};

}  // namespace saccade
