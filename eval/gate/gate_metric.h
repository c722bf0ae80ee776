#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "eval/metrics/catalogue.h"

namespace saccade {

/// The time that a stored baseline is held against.
inline constexpr std::string_view kGateTime = "speed.wall_s.median";

/// The metrics that are judged, of all modules: few, since every further one takes evidence from
/// the others, and none that is the worst of many samples, since those scatter. Each has a floor.
[[nodiscard]] std::span<const MetricInfo> gate_metrics();

/// Whether its sign alone is judged: of a fit that comes before the scores and hides a negative.
[[nodiscard]] bool is_judged_by_sign(std::string_view key);

/// Floor of a metric that is judged because somebody asked for it.
inline constexpr double kDefaultFloor = 1e-6;

/// d = ln((after + floor) / (before + floor)), negated where higher is better: above 0 is worse.
/// nullopt where either sum is not positive.
[[nodiscard]] std::optional<double> worsening(const MetricInfo& metric, double before,
                                              double after);

/// The relative change of the metric that such a d stands for, e.g. 0.05 for 5 % more.
[[nodiscard]] double relative_change(const MetricInfo& metric, double worse);

}  // namespace saccade
