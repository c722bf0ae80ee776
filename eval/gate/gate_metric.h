#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace saccade {

/// How the gate weighs a metric. Which way is better is metric_info()'s to say.
struct GateMetric {
  std::string key;
  /// Added to both values of a ratio: changes far below it do not count, and 0 has a logarithm. In
  /// the metric's unit, > 0.
  double floor = 1e-6;
  /// The smallest relative change that counts, where the metric has one of its own.
  std::optional<double> tolerance;
};

/// The time that a stored baseline is held against.
inline constexpr std::string_view kGateTime = "speed.wall_s.median";

/// The metrics that are judged, of all modules: few, since every further one takes evidence from
/// the others, and none that is the worst of many samples, since those scatter.
[[nodiscard]] std::span<const GateMetric> gate_metrics();

/// Of any key; one that is not among gate_metrics() has the defaults.
[[nodiscard]] GateMetric gate_metric(const std::string& key);

/// Whether its sign alone is judged: of a fit that comes before the scores and hides a negative.
[[nodiscard]] bool is_judged_by_sign(std::string_view key);

/// d = ln((after + floor) / (before + floor)), negated where higher is better: above 0 is worse.
/// nullopt where either sum is not positive.
[[nodiscard]] std::optional<double> worsening(const GateMetric& metric, double before,
                                              double after);

/// The relative change of the metric that such a d stands for, e.g. 0.05 for 5 % more.
[[nodiscard]] double relative_change(const GateMetric& metric, double worse);

}  // namespace saccade
