#include "eval/metrics/trajectory/loss_metrics.h"

#include <algorithm>

#include "core/time_search.h"

namespace saccade {
namespace {

/// True error from which tracking counts as lost.
constexpr double kLostDepthPercent = 5;
constexpr double kLostDeg = 5;

/// Root mean square position error of a run that succeeded, relative to the mean depth.
constexpr double kSuccessfulError = 0.01;

/// Instants of the grid, counted.
struct LossCounts {
  double lost = 0;
  double reported = 0;
  double both = 0;
  double losses = 0;
  double delay = 0;  ///< over all losses
};

LossCounts count_losses(const std::vector<bool>& lost, const std::vector<bool>& reported) {
  LossCounts counts;
  bool was_reported = false;
  for (std::size_t i = 0; i < lost.size(); ++i) {
    counts.reported += reported[i] ? 1 : 0;
    if (!lost[i]) continue;
    const bool begins = i == 0 || !lost[i - 1];
    if (begins) was_reported = false;
    counts.losses += begins ? 1 : 0;
    counts.lost += 1;
    counts.both += reported[i] ? 1 : 0;
    was_reported = was_reported || reported[i];
    counts.delay += was_reported ? 0 : 1;
  }
  return counts;
}

std::vector<bool> reported_lost(const ErrorSeries& series, std::span<const PoseStatus> rows) {
  std::vector<bool> reported;
  for (const double t_s : series.t_s) {
    const std::optional<std::size_t> row = row_in_force(rows, t_s);
    reported.push_back(row && rows[*row].is_lost);
  }
  return reported;
}

/// From the begin of the series to the first loss; nullopt without one.
std::optional<double> first_loss_s(const ErrorSeries& series) {
  const std::vector<bool> lost = truly_lost(series);
  const auto first = std::find(lost.begin(), lost.end(), true);
  if (first == lost.end()) return std::nullopt;
  return series.t_s[static_cast<std::size_t>(first - lost.begin())] - series.t_s.front();
}

std::optional<double> fraction(double part, double whole) {
  return whole > 0 ? std::optional(part / whole) : std::nullopt;
}

}  // namespace

std::vector<bool> truly_lost(const ErrorSeries& series) {
  std::vector<bool> lost;
  for (std::size_t i = 0; i < series.dt_rel_percent.size(); ++i)
    lost.push_back(series.dt_rel_percent[i] > kLostDepthPercent || series.dtheta_deg[i] > kLostDeg);
  return lost;
}

std::optional<std::size_t> row_in_force(std::span<const PoseStatus> rows, double t_s) {
  if (rows.empty()) return std::nullopt;
  const std::size_t until = count_until(rows, t_s, &PoseStatus::t_s);
  return until == 0 ? 0 : until - 1;
}

Metrics score_loss(const TrajectoryScoreInput& input) {
  const ErrorSeries series = errors_over_time(input);
  std::optional<double> precision, recall, delay_ms, unreported_s, reported_s, losses;
  if (input.reported && !series.dt_rel_percent.empty()) {
    const LossCounts counts =
        count_losses(truly_lost(series), reported_lost(series, *input.reported));
    const auto interval = scored_interval(input.truth, input.window);
    // As of trajectory.lost_s, so that the two add up.
    const double spacing_s =
        (interval->end_s - interval->start_s) / static_cast<double>(series.t_s.size());
    precision = fraction(counts.both, counts.reported);
    recall = fraction(counts.both, counts.lost);
    unreported_s = spacing_s * (counts.lost - counts.both);
    reported_s = spacing_s * counts.reported;
    losses = counts.losses;
    if (counts.losses > 0) delay_ms = 1e3 * kScoreStepS * counts.delay / counts.losses;
  }
  Metrics metrics;
  metrics.set("trajectory.loss.first_s", first_loss_s(series));
  metrics.set("trajectory.loss.precision", precision);
  metrics.set("trajectory.loss.recall", recall);
  metrics.set("trajectory.loss.delay_ms", delay_ms);
  metrics.set("trajectory.loss.unreported_s", unreported_s);
  metrics.set("trajectory.loss.reported_s", reported_s);
  metrics.set("trajectory.loss.count", losses);
  return metrics;
}

std::optional<double> position_error_m(const Metrics& scores) {
  const bool is_aligned = scores.get("trajectory.aligned_freedoms").has_value();
  return scores.get(is_aligned ? "trajectory.dt_m.rmse" : "trajectory.none.ate_rmse_m");
}

std::optional<double> success_of(const Metrics& scores) {
  const std::optional<double> depth_m = scores.get("trajectory.mean_depth_m");
  if (!depth_m || !scores.get("trajectory.duration_s")) return std::nullopt;
  const std::optional<double> error_m = position_error_m(scores);
  const std::optional<double> lost_s = scores.get("trajectory.lost_s");
  return error_m && lost_s && *error_m < kSuccessfulError * *depth_m && *lost_s == 0 ? 1 : 0;
}

}  // namespace saccade
