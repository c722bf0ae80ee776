#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "core/camera.h"
#include "core/trajectory.h"
#include "estimator/depth/rays/ray_depth.h"
#include "estimator/refinement/cost_log.h"
#include "estimator/refinement/inertial_rows.h"
#include "estimator/refinement/path_correction.h"

namespace saccade {

struct JointRefinementOptions {
  /// Of the knots of a spline through the given path: it keeps a hand's motion and loses jitter.
  double smoothing_s = 0.025;
  double knot_spacing_s = 0.05;  ///< of the path's correction, which is slower than the motion
  double window_s = 1.6;         ///< events that a keyframe's edges are sought in, around its view
  int edges = 600;               ///< of a keyframe, at most, evenly chosen
  int events_per_edge = 30;      ///< at most, evenly in time
  /// Beside them, of the start's: only while the poses are known do events say how far away an edge
  /// is in the unit of the path, and so what the path's scale is.
  int known_events_per_edge = 100;
  /// Beside them, of the same edge in keyframes whose windows are later and apart: what is seen
  /// again holds a long path. Of so many keyframes and, in each, so many events, at most.
  int again_keyframes = 4;
  int again_events = 10;
  double noise_px = 0.1;       ///< least deviation of an event from its edge
  double outlier = 2;          ///< deviations beyond which an event counts less (Cauchy)
  double tilt_sigma = 0.3;     ///< of an edge's tilt m from 0
  double hysteresis_px = 0.5;  ///< of h from 0
  double step_px = 0.5;        ///< of k from 0
  double offset_px = 2;        ///< of c from 0
  double hold_px = 30;         ///< of the correction from none, as image motion
  /// By which the correction bends from one knot to the next, as image motion: its slope's random
  /// walk over a second. What a tracker is off by grows evenly; it holds the path's ends, where few
  /// events do.
  double bend_px = 30;
  double known_sigma_px = 0.02;  ///< of the poses of the start, as image motion
  int rounds = 2;                ///< of finding the keyframes' edges, and adjusting
  int iterations = 10;           ///< of Levenberg-Marquardt in a round, at most
  double information = 0.04;     ///< of that of independent residuals: neighbouring ones err alike
  InertialRowsOptions imu;

  /// Steps of work, as far as progress goes.
  [[nodiscard]] std::size_t steps() const {
    return static_cast<std::size_t>(rounds) * static_cast<std::size_t>(iterations + 1);
  }
};

/// What is refined.
struct JointStart {
  std::vector<StampedPose> path;  ///< spans the events
  /// Poses that hold the place and, where there is more than one, the scale.
  std::vector<StampedPose> known;
  std::vector<double> keyframe_s;  ///< times of the keyframes' views
  double typical_depth_m = 1;      ///< turns pixels into metres
  std::optional<MountedImu> imu;   ///< for options.imu.use
  bool is_metric = true;           ///< the path is in metres; else the readings say the scale
};

struct JointResult {
  Trajectory path;  ///< every millisecond
  SplineKnots knots;
  Eigen::MatrixXd covariance;  ///< of the correction's twists; empty where it is not determined
  std::optional<InertialAlignment> inertial;  ///< what the readings say, in the last round
  CostLog costs;
  std::size_t observations = 0;  ///< in the last round
  double residual_px = 0;        ///< robust deviation of the events from their edges

  /// Of the pose at a time: the twist (v, w) in the camera's axes. 0 where it is not determined.
  [[nodiscard]] Matrix6 covariance_at(double t_s) const;
};

/// The joint optimum of a camera's whole path and the edges of all keyframes: one bundle adjustment
/// over all keyframes' windows, which overlap and so hold each other, by Ceres with the edges
/// eliminated first. Scale and place are those of the start's known poses. With an inertial sensor
/// its readings between instants of the path join in, with gravity, biases and time offset and, of
/// a path that is not metric, the scale; the path stays in its unit. Deterministic for any number
/// of threads. `progress` is called with the steps done since its last call, of options.steps() in
/// all.
[[nodiscard]] JointResult refine_jointly(std::span<const Event> events, const JointStart& start,
                                         const PinholeCamera& camera, const RayDepth& depth,
                                         const JointRefinementOptions& options,
                                         const std::function<void(std::size_t)>& progress = {});

}  // namespace saccade
