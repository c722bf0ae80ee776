#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "core/camera.h"
#include "core/config/fields.h"
#include "estimator/depth/depth_estimator.h"
#include "estimator/depth/rays/edgel_refiner.h"
#include "estimator/depth/rays/edgel_seeds.h"
#include "estimator/depth/rays/event_assignment.h"
#include "estimator/depth/rays/event_rays.h"
#include "estimator/depth/rays/gate_counts.h"
#include "estimator/depth/rays/local_planes.h"
#include "estimator/depth/rays/planar_fusion.h"
#include "estimator/depth/rays/stream_delay.h"

namespace saccade {

struct RayDepthOptions {
  /// Time slices of a window in which events are looked up by pixel; with 64 the first stages have
  /// too few events.
  static constexpr int kTimeSlices = 24;

  RefinerOptions refiner;
  /// Views with fewer points are estimated again with opened gates; 0: never.
  int least_points = 200;
  /// By how much the gates of accuracy are opened: what a point must have moved is divided by it, its
  /// largest sigma multiplied.
  double gate_opening = 1;
  /// For poses that are not adjusted by the depths: regressions go on until they have converged, `fills`, and
  /// fusion.widens. They give more and better points at a third more time.
  [[nodiscard]] RayDepthOptions for_given_poses() const;
  /// Edgels and points of `factor` times the sigma count, too.
  [[nodiscard]] RayDepthOptions with_larger_sigmas(double factor) const;
  [[nodiscard]] RayDepthOptions opened(double opening, const DepthLimits& limits) const;
  /// Relative, of the own events of an edgel that is confirmed by its neighbours.
  double propagation_max_sigma = 0.05;
  FusionOptions fusion;
  /// Whether seeds of another depth than their neighbours', too, are tried at theirs where these are many
  /// and all around: their depth in the sweep is that of votes of other edges.
  bool fills = false;
  bool find_delay = true;  ///< of the events behind the poses (stream_delay.h), and to take it out
  /// Where set, edgels whose depth their events do not tell are found, too, at this inverse depth
  /// [1/m] within kAssumedSigma of it: they say how the camera rotates.
  std::optional<double> assumed_inverse_depth;
  static constexpr double kAssumedSigma = 0.5;

  /// Whether the depth of an edgel is rather assumed than found.
  [[nodiscard]] bool is_assumed(const FittedEdgel& edgel) const {
    return assumed_inverse_depth &&
           static_cast<double>(edgel.sigma) > std::max(refiner.max_sigma, propagation_max_sigma) *
                                                  static_cast<double>(edgel.edge.inverse_depth);
  }
};

void describe(config::Fields& fields, RayDepthOptions& options);

/// How far the noise of a window's poses moves an edge over the window: the poses' own noise,
/// divided by the square root of their number.
struct PoseError {
  float rotation_px = 0;    ///< by their orientation
  float position_px_m = 0;  ///< by their position, of an edge at inverse depth 1/m

  /// Standard deviation of an edgel's inverse depth by it [1/m]: the regression divides it by the
  /// same parallax as the residuals of its events, of which sigma averages `support`.
  [[nodiscard]] float sigma_of(const FittedEdgel& edgel) const;
};

/// The edgels of a window before their depths are fused.
struct WindowEdgels {
  std::vector<FittedEdgel> edges;  ///< `first` and `last` are indices into `events`
  /// Edges before this one need no assumed depth. Of what find_edgels() returns.
  std::size_t first_assumed = 0;
  EdgelEvents
      events;  ///< indices into the rays until the end of find_edgels(), then into the window
  std::vector<Eigen::Vector2f> seeds;
  std::vector<std::pair<std::string, double>> stages_s;
  GateCounts dropped;
  PoseError pose_error;
  StreamDelay delay;  ///< that was taken out
};

/// Seeds by horizontal strips of the view, which are processed in parallel.
using SeedStrips = std::vector<std::vector<EdgelSeed>>;

/// Depth of edge points from the rays of all events, without a reference image. Seeds come from a
/// space sweep; the inverse depth of each is estimated by a regression over the rays near it, first
/// those near the reference time, then, as the depth gets better, over the whole window.
class RayDepth : public DepthEstimator {
 public:
  RayDepth(const RayDepthOptions& options, const DepthLimits& limits, const PinholeCamera& camera);

  /// A view that gets too few points is estimated again with its gates opened step by step: few
  /// events and short paths give coarse depths, and their sigmas say so.
  [[nodiscard]] DepthResult estimate(const ViewWindow& window) const override;

  /// What `estimate` makes of this, then of the same with gates opened step by step until `points_of`
  /// it are enough; that with the most points.
  template <class Result, class Estimate, class PointsOf>
  [[nodiscard]] Result with_open_gates(const Estimate& estimate, const PointsOf& points_of) const {
    Result best = estimate(*this);
    for (const double opening : kOpenings) {
      if (points_of(best) >= enough_points()) break;
      RayDepth opened(*this);
      opened.options_ = options_.opened(opening, limits_);
      Result result = estimate(opened);
      if (points_of(result) >= points_of(best)) best = std::move(result);
    }
    return best;
  }

  /// The first half of estimate(), for callers that adjust the edgels before the second, fuse().
  /// The events are as late behind the poses as the window says: those who adjust the poses by them
  /// must not find a delay, which looks like the poses' own error.
  [[nodiscard]] WindowEdgels find_edgels(const ViewWindow& window) const;
  /// The same of poses from elsewhere, which the events may come later than (`find_delay`).
  [[nodiscard]] WindowEdgels find_delayed_edgels(const ViewWindow& window) const;
  [[nodiscard]] DepthResult fuse(const WindowEdgels& found) const;

 private:
  /// Gates are opened by these; by the last one depths that are known to 12 % pass best.yaml.
  static constexpr std::array kOpenings = {3.0, 10.0};

  /// RayDepthOptions::least_points, but no more than a share of the pixels.
  [[nodiscard]] std::size_t enough_points() const;
  [[nodiscard]] WindowEdgels find_edgels(const ViewWindow& window, bool may_be_delayed) const;
  /// By some of the seeds; it is taken out of the window's `rays`.
  [[nodiscard]] StreamDelay find_delay(const ViewWindow& window, const SeedStrips& strips,
                                       EventRays& rays) const;
  void refine_seeds(const EventRays& rays, const SeedStrips& strips, WindowEdgels& found) const;
  void propagate(const EventRays& rays, const SeedStrips& strips, WindowEdgels& found) const;
  void assume(const EventRays& rays, WindowEdgels& found) const;
  [[nodiscard]] std::optional<FittedEdgel> confirm(const EdgelSeed& seed, const EdgePoint& nearest,
                                                   LocalPlanes& planes, EdgelRefiner& refiner,
                                                   EdgelEvents& events) const;
  [[nodiscard]] std::vector<EdgePoint> points_of(const WindowEdgels& found) const;
  [[nodiscard]] PoseError pose_error_over(const ViewWindow& window) const;

  RayDepthOptions options_;
  DepthLimits limits_;
  PinholeCamera camera_;  ///< undistorted
  UndistortionTable undistortion_;
};

}  // namespace saccade
