#pragma once

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "eval/metrics/catalogue.h"

namespace saccade {

/// The time that a stored baseline is held against.
inline constexpr std::string_view kGateTime = "speed.wall_s.median";

/// The metrics that are judged, of all modules: few, since every further one takes evidence from
/// the others, and none that is the worst of many samples, since those scatter. Each has a floor.
[[nodiscard]] inline std::span<const MetricInfo> gate_metrics() {
  static const std::vector<MetricInfo> metrics = [] {
    std::vector<MetricInfo> judged;
    std::copy_if(metric_catalogue().begin(), metric_catalogue().end(), std::back_inserter(judged),
                 [](const MetricInfo& metric) { return metric.floor.has_value(); });
    return judged;
  }();
  return metrics;
}

/// Whether its sign alone is judged: of a fit that comes before the scores and hides a negative.
[[nodiscard]] inline bool is_judged_by_sign(std::string_view key) {
  return key.ends_with(".fit.scale");
}

/// Floor of a metric that is judged because somebody asked for it.
inline constexpr double kDefaultFloor = 1e-6;

/// d = ln((after + floor) / (before + floor)), negated where higher is better: above 0 is worse.
/// nullopt where either sum is not positive.
[[nodiscard]] inline std::optional<double> worsening(const MetricInfo& metric, double before,
                                                     double after) {
  const double floor = metric.floor.value_or(kDefaultFloor);
  if (before + floor <= 0 || after + floor <= 0) return std::nullopt;
  const double change = std::log((after + floor) / (before + floor));
  return metric.higher_is_better() ? -change : change;
}

/// The relative change of the metric that such a d stands for, e.g. 0.05 for 5 % more.
[[nodiscard]] inline double relative_change(const MetricInfo& metric, double worse) {
  return std::expm1(metric.higher_is_better() ? -worse : worse);
}

}  // namespace saccade
