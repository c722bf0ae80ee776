#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "core/camera.h"
#include "core/trajectory.h"
#include "estimator/depth/rays/ray_depth.h"
#include "estimator/edges/least_squares/cost_log.h"
#include "estimator/edges/least_squares/path_covariance.h"
#include "estimator/edges/path/inertial_factors.h"
#include "estimator/edges/path/path_edge_problem.h"

namespace saccade {

struct BatchAdjustmentOptions {
  double smoothing_s = 0.025;  ///< knots of the given path: follows a hand's motion, removes jitter
  double window_s = 1.6;       ///< of the events around a view in which its edges are found
  int events_per_edge = 30;    ///< at most, evenly in time
  int given_events_per_edge = 100;  ///< beside them, while poses are given: the scale is theirs
  int rounds = 2;                   ///< of finding the edges, and adjusting them with the path
  /// An edge is observed again by views a window away.
  PathEdgeProblemOptions problem;
  double information_ratio = 0.04;  ///< of that of independent residuals: neighbours err alike
  bool use_imu = false;             ///< BatchInput::imu joins in
  double imu_interval_s = 0.1;      ///< over which its samples are preintegrated

  /// Steps of work, as far as progress goes.
  [[nodiscard]] std::size_t steps() const {
    return static_cast<std::size_t>(rounds) * static_cast<std::size_t>(problem.iterations + 1);
  }
};

/// What is adjusted.
struct BatchInput : PathInput {
  std::vector<double> keyframe_s;  ///< times of the keyframes' views
  std::optional<MountedImu> imu;   ///< for options.use_imu
  bool is_metric = true;           ///< the path is in metres; else the samples say the scale
};

struct BatchAdjustment {
  Trajectory path;  ///< every millisecond
  SplineKnots knots;
  SplineCovariances covariances;  ///< of the correction's twists; empty: they are not determined
  std::optional<InertialAlignment> inertial;  ///< what the samples say, in the last round
  CostLog costs;
  std::size_t observations = 0;  ///< in the last round
  double residual_px = 0;        ///< robust standard deviation of the events from their edges

  /// Of the pose at a time: the twist (v, w) in the camera's axes. 0 where it is not determined.
  [[nodiscard]] Matrix6 covariance_at(double t_s) const;
};

/// The batch optimum of a camera's whole path and the edges of all keyframes: one bundle adjustment
/// over the windows of views along the path (batch_views()), which overlap and so constrain each
/// other (PathEdgeProblem). The given poses of the start fix the gauge. With an inertial sensor its
/// preintegrated samples join in (inertial_cost.h), with gravity, biases and time offset and, of a
/// path that is not metric, the scale; the path stays in its unit. Deterministic for any number of
/// threads. `progress` is called with the steps done since its last call, of options.steps() in
/// all.
[[nodiscard]] BatchAdjustment adjust_batch(std::span<const Event> events, const BatchInput& input,
                                           const PinholeCamera& camera, const RayDepth& depth,
                                           const BatchAdjustmentOptions& options,
                                           const std::function<void(std::size_t)>& progress = {});

/// The events that a keyframe's edges are sought in.
[[nodiscard]] std::span<const Event> events_of_view(std::span<const Event> events, double t_s,
                                                    double window_s);

/// Times of views from those of the keyframes, which are in order and at least one. A keyframe nearer
/// than a quarter of a window to the view before it is left out, since windows that overlap more show
/// the same edges again, and views are added so that none is farther than a third from the next and
/// from the end: where no window reaches, nothing constrains the path.
[[nodiscard]] std::vector<double> batch_views(const std::vector<double>& keyframe_s, double end_s,
                                              double window_s);

}  // namespace saccade
