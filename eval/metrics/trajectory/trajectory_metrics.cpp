#include "eval/metrics/trajectory/trajectory_metrics.h"

#include <algorithm>

#include "eval/metrics/statistics.h"
#include "eval/metrics/trajectory/loss_metrics.h"
#include "eval/metrics/trajectory/relative_error.h"

namespace saccade {
namespace {

ErrorSeries series_of(const ScoredSamples& samples, const std::optional<double>& mean_depth_m) {
  ErrorSeries series;
  series.t_s = samples.t_s;
  for (std::size_t i = 0; i < samples.t_s.size(); ++i) {
    const Rigid3& estimated = samples.estimated[i];
    const Rigid3& truth = samples.truth[i];
    const double error_m = (estimated.translation() - truth.translation()).norm();
    series.dt_m.push_back(error_m);
    if (mean_depth_m) series.dt_rel_percent.push_back(100 * error_m / *mean_depth_m);
    series.dtheta_deg.push_back(kDegreesPerRadian *
                                angle_between(estimated.rotation(), truth.rotation()));
  }
  return series;
}

/// Null where less is aligned than the world of the estimate is free in.
void set_aligned(Metrics& metrics, const std::string& key, std::span<const PosePair> pairs,
                 Alignment alignment, Alignment freedom) {
  // The smallest error of the positions; a rotation about a straight path leaves them alone.
  const Similarity by_positions = align_positions(pairs, alignment);
  const Similarity by_poses = align(pairs, alignment);
  std::vector<double> trans_m, rot_deg;
  for (const PosePair& pair : pairs) {
    trans_m.push_back(
        (by_positions * pair.estimated.translation() - pair.truth.translation()).norm());
    rot_deg.push_back(kDegreesPerRadian *
                      angle_between((by_poses * pair.estimated).rotation(), pair.truth.rotation()));
  }
  std::optional<double> ate, rot, scale;
  if (!pairs.empty() && alignment >= freedom) {
    ate = statistics_of(trans_m).rmse;
    rot = statistics_of(rot_deg).rmse;
    scale = by_positions.scale;
  }
  metrics.set(key + ".ate_rmse_m", ate);
  metrics.set(key + ".rot_rmse_deg", rot);
  metrics.set(key + ".scale", scale);
}

/// Of the protocol of Rebecq et al. (BMVC 2017): SE(3) by the poses of the first 5 s alone.
std::optional<double> error_after_begin_percent(const TrajectoryScoreInput& input,
                                                const RunRecord::Window& interval,
                                                std::span<const PosePair> pairs, double path_m) {
  constexpr double kBeginS = 5;
  if (interval.end_s - interval.start_s <= kBeginS || path_m <= 0 ||
      input.freedom > Alignment::kSe3)
    return std::nullopt;
  std::size_t begin = 0;
  for (const StampedPose& pose : input.estimate.poses())
    if (pose.t_s >= interval.start_s && pose.t_s <= interval.start_s + kBeginS) ++begin;
  if (begin == 0) return std::nullopt;
  const Similarity truth_from_estimate = align_positions(pairs.first(begin), Alignment::kSe3);
  double sum_m = 0;
  for (const PosePair& pair : pairs)
    sum_m += (truth_from_estimate * pair.estimated.translation() - pair.truth.translation()).norm();
  return 100 * sum_m / static_cast<double>(pairs.size()) / path_m;
}

std::optional<double> lost_s(const ErrorSeries& series, double duration_s) {
  const std::vector<bool> is_lost = truly_lost(series);
  if (is_lost.empty()) return std::nullopt;
  const auto lost = std::count(is_lost.begin(), is_lost.end(), true);
  return duration_s * static_cast<double>(lost) / static_cast<double>(is_lost.size());
}

}  // namespace

Similarity truth_from_estimate(const TrajectoryScoreInput& input) {
  if (input.freedom == Alignment::kNone) return {};
  const std::vector<PosePair> pairs = associate(input);
  return input.mean_depth_m ? align_views(pairs, input.freedom, *input.mean_depth_m)
                            : align(pairs, input.freedom);
}

ScoredSamples scored_samples(const TrajectoryScoreInput& input) {
  const std::optional<RunRecord::Window> interval = scored_interval(input.truth, input.window);
  if (!interval) return {};
  // Where nothing of an estimate in a world of its own can be aligned, nothing can be compared.
  const bool is_free = input.freedom != Alignment::kNone;
  if (is_free && associate(input).empty()) return {};
  ScoredSamples samples = take_samples(input.estimate, input.truth, *interval);
  if (!is_free) return samples;
  const Similarity aligned = truth_from_estimate(input);
  for (Rigid3& pose : samples.estimated) pose = aligned * pose;
  return samples;
}

ErrorSeries errors_over_time(const TrajectoryScoreInput& input) {
  return series_of(scored_samples(input), input.mean_depth_m);
}

std::vector<PosePair> associate(const TrajectoryScoreInput& input) {
  std::vector<PosePair> pairs;
  const std::optional<RunRecord::Window> interval = scored_interval(input.truth, input.window);
  if (!interval) return pairs;
  for (const StampedPose& pose : input.estimate.poses())
    if (pose.t_s >= interval->start_s && pose.t_s <= interval->end_s)
      pairs.push_back({pose.world_from_camera, input.truth.at_clamped(pose.t_s)});
  return pairs;
}

double reported_lost_s(const std::vector<PoseStatus>& reported, const RunRecord::Window& interval) {
  double lost = 0;
  for (std::size_t i = 0; i < reported.size(); ++i) {
    if (!reported[i].is_lost) continue;
    const double until = i + 1 < reported.size() ? reported[i + 1].t_s : interval.end_s;
    lost += std::max(0.0,
                     std::min(until, interval.end_s) - std::max(reported[i].t_s, interval.start_s));
  }
  return lost;
}

Metrics score_trajectory(const TrajectoryScoreInput& input) {
  Metrics metrics;
  const std::optional<RunRecord::Window> interval = scored_interval(input.truth, input.window);
  const ScoredSamples samples = scored_samples(input);
  const ErrorSeries series = series_of(samples, input.mean_depth_m);
  set_statistics(metrics, "trajectory.dt_rel_percent", series.dt_rel_percent);
  set_statistics(metrics, "trajectory.dt_m", series.dt_m);
  set_statistics(metrics, "trajectory.dtheta_deg", series.dtheta_deg);

  const std::vector<PosePair> pairs = associate(input);
  set_aligned(metrics, "trajectory.none", pairs, Alignment::kNone, input.freedom);
  set_aligned(metrics, "trajectory.yaw", pairs, Alignment::kYaw, input.freedom);
  set_aligned(metrics, "trajectory.se3", pairs, Alignment::kSe3, input.freedom);
  set_aligned(metrics, "trajectory.sim3", pairs, Alignment::kSim3, input.freedom);
  set_relative_errors(metrics, samples);
  metrics.set("trajectory.drift_percent", drift_percent(samples));

  const bool is_aligned = input.freedom != Alignment::kNone && !pairs.empty();
  metrics.set("trajectory.aligned_freedoms",
              is_aligned ? std::optional(freedoms_of(input.freedom)) : std::nullopt);
  metrics.set("trajectory.poses", static_cast<double>(input.estimate.size()));
  metrics.set("trajectory.mean_depth_m", input.mean_depth_m);
  std::optional<double> covered, duration, path, lost, reported, after_begin;
  if (interval) {
    duration = interval->end_s - interval->start_s;
    covered = coverage(input.estimate, *interval);
    if (!samples.t_s.empty()) path = path_lengths(samples).back();
    lost = lost_s(series, *duration);
    after_begin = error_after_begin_percent(input, *interval, pairs, path.value_or(0));
    if (input.reported) reported = reported_lost_s(*input.reported, *interval);
  }
  metrics.set("trajectory.se3_5s.mean_percent", after_begin);
  metrics.set("trajectory.coverage", covered);
  metrics.set("trajectory.duration_s", duration);
  metrics.set("trajectory.path_length_m", path);
  metrics.set("trajectory.lost_s", lost);
  metrics.set("trajectory.reported_lost_s", reported);
  return metrics;
}

}  // namespace saccade
