#include "eval/metrics/outcome.h"

#include <fmt/format.h>

#include "eval/metrics/statistics.h"
#include "eval/metrics/trajectory/loss_metrics.h"
#include "eval/table/number_text.h"

namespace saccade {

std::optional<SuccessShare> success_share(std::span<const RunOutcome> runs) {
  double successes = 0;
  std::size_t count = 0;
  bool is_known = false;
  for (const RunOutcome& run : runs) {
    is_known = is_known || run.success;
    if (run.has_failed || run.success) ++count;
    if (!run.has_failed) successes += run.success.value_or(0);
  }
  if (!is_known) return std::nullopt;
  const ProportionInterval interval = wilson_95(successes, static_cast<double>(count));
  return SuccessShare{successes / static_cast<double>(count), interval.low, interval.high, count};
}

bool was_lost(const Metrics& metrics) {
  return metrics.get("success") == 0.0 && (metrics.get("trajectory.lost_s").value_or(0) > 0 ||
                                           metrics.get("trajectory.poses") == 0.0);
}

std::string failure_text(const Metrics& metrics, const std::string& problem) {
  if (!problem.empty()) return problem;
  if (metrics.get("success").value_or(1) > 0) return "";
  if (metrics.get("trajectory.loss.first_s"))
    return fmt::format("lost after {} s", rounded(metrics.get("trajectory.loss.first_s")));
  const std::optional<double> error_m = position_error_m(metrics);
  const std::optional<double> depth_m = metrics.get("trajectory.mean_depth_m");
  if (!error_m || !depth_m) return "no pose";
  return fmt::format("ATE of {} % of the depth", rounded(100 * *error_m / *depth_m));
}

}  // namespace saccade
