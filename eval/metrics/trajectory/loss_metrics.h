#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "eval/metrics/metrics.h"
#include "eval/metrics/trajectory/trajectory_metrics.h"

namespace saccade {

/// For each instant of the series whether tracking is lost there: the true error is above 5 % of
/// the mean depth or 5 degrees. Empty where no mean depth is known.
[[nodiscard]] std::vector<bool> truly_lost(const ErrorSeries& series);

/// Index of the row of poses.csv that is in force at `t_s`: the last one at or before it, as its
/// pose is the one that is held; before the first row the first. nullopt without rows.
[[nodiscard]] std::optional<std::size_t> row_in_force(std::span<const PoseStatus> rows, double t_s);

/// What a run says of being lost against the truth, over the grid of the scored interval:
/// trajectory.loss.{precision,recall,delay_ms,unreported_s,reported_s,count}, and first_s. With L the
/// instants that are truly lost, R those at which the row in force says `lost`, and w the time of
/// one (the interval's length over their number, as of trajectory.lost_s),
///   precision = |L and R| / |R|,  recall = |L and R| / |L|,  unreported_s = w |L without R|,
///   reported_s = w |R|,  count = losses, the runs of consecutive instants of L,
///   delay_ms = mean over the losses of the time from their begin to the first report in them, the
/// whole length of a loss that is never reported. What has no denominator is null; all of them are
/// where the run reports no status or no error is known.
/// first_s is the time from the begin of the interval to the first instant of L, whatever the run
/// reports.
[[nodiscard]] Metrics score_loss(const TrajectoryScoreInput& input);

/// What success is judged by: the ATE without alignment; of a run in a world of its own
/// (trajectory.aligned_freedoms) the RMSE over time after its alignment.
[[nodiscard]] std::optional<double> position_error_m(const Metrics& scores);

/// 1 where the run succeeded: its positions err by less than 1 % of the mean depth
/// (position_error_m()) and tracking was never lost; else 0, also where it found no pose. nullopt
/// where the truth or the depth is missing. `scores`: those of score_trajectory().
[[nodiscard]] std::optional<double> success_of(const Metrics& scores);

}  // namespace saccade
