#pragma once

#include <optional>
#include <vector>

#include "core/trajectory.h"
#include "eval/metrics/metrics.h"
#include "eval/metrics/trajectory/align.h"
#include "eval/metrics/trajectory/scored_samples.h"

namespace saccade {

/// One row of poses.csv, as far as it is scored.
struct PoseStatus {
  double t_s = 0;
  bool is_lost = false;
  /// That the pose is within the limits of a loss (truly_lost()); nullopt: not stated.
  std::optional<double> probability = {};
};

struct TrajectoryScoreInput {
  Trajectory estimate;
  Trajectory truth;  ///< empty: everything but the number of poses is null
  std::optional<RunRecord::Window>
      window;                          ///< what the estimator was given; nullopt: all of the truth
  std::optional<double> mean_depth_m;  ///< d of dt_rel (thesis 8.1), > 0
  /// In order of time; nullopt: the estimator reports no status.
  std::optional<std::vector<PoseStatus>> reported;
  /// What no input says of the estimate's world, so that it is taken from the truth before errors
  /// are taken: nothing where poses were given at the start; kSim3 after a start from events alone,
  /// kYaw where an inertial sensor then told metres and the vertical.
  Alignment freedom = Alignment::kNone;
};

/// Errors over time on the 1 ms grid of the scored interval.
struct ErrorSeries {
  std::vector<double> t_s;
  std::vector<double> dt_m;            ///< |t - t_gt|
  std::vector<double> dt_rel_percent;  ///< 100 |t - t_gt| / d (thesis 8.1); empty without d
  std::vector<double> dtheta_deg;      ///< angle between q and q_gt (thesis 8.2)
};

/// The alignment of `input.freedom` by all poses in the scored interval: align_views() where a depth
/// is known, else align(). The identity where there is no such pose.
[[nodiscard]] Similarity truth_from_estimate(const TrajectoryScoreInput& input);

/// Estimate, after that alignment, and truth on the grid of the scored interval; empty where one of
/// them is missing.
[[nodiscard]] ScoredSamples scored_samples(const TrajectoryScoreInput& input);

/// Their errors; empty where there is no estimate or nothing to score against.
[[nodiscard]] ErrorSeries errors_over_time(const TrajectoryScoreInput& input);

/// Every key below "trajectory." except reprojection_px, nees and loss (see docs/metrics.md for the definitions);
/// what cannot be computed is null. The set of keys never depends on the input.
[[nodiscard]] Metrics score_trajectory(const TrajectoryScoreInput& input);

/// Estimated poses, as they are, inside the scored interval with the truth interpolated at their
/// times: what ATE is computed over.
[[nodiscard]] std::vector<PosePair> associate(const TrajectoryScoreInput& input);

/// Time between a lost pose and the next one that is not lost, cut to the interval [s].
[[nodiscard]] double reported_lost_s(const std::vector<PoseStatus>& reported,
                                     const RunRecord::Window& interval);

}  // namespace saccade
