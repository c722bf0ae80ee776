#include "eval/report/charts/timed_error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace saccade {
namespace {

/// Half of what the chart of a single run shows: there are several in one.
constexpr std::size_t kMaxComparedPoints = 800;

std::string first_letter_up(std::string text) {
  text.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(text.front())));
  return text;
}

/// What an axis of logarithms can show.
CurvePoints above_zero(const CurvePoints& all) {
  CurvePoints points;
  for (std::size_t i = 0; i < all.x.size(); ++i)
    if (all.y[i] > 0) points.add(all.x[i], all.y[i]);
  return points;
}

}  // namespace

std::vector<double> TimedError::values_of(const RunData& run) const {
  std::vector<double> values = run.errors.*series;
  for (double& value : values) value *= scale;
  return values;
}

std::string TimedError::axis() const { return fmt::format("{} [{}]", label, unit); }

std::vector<TimedError> timed_errors(std::span<const RunData* const> runs) {
  const TimedError absolute{"dt", "position error", "mm", 1e3, &ErrorSeries::dt_m};
  const TimedError relative{"dt_rel", "relative position error", "%", 1,
                            &ErrorSeries::dt_rel_percent};
  const bool all_know = std::all_of(runs.begin(), runs.end(), [](const RunData* run) {
    return run->errors.t_s.empty() || run->input.mean_depth_m;
  });
  return {all_know ? relative : absolute,
          {"dtheta", "rotation error", "deg", 1, &ErrorSeries::dtheta_deg}};
}

PageChart chart_over_time(const TimedError& error, const std::string& scope,
                          std::span<const std::pair<ChartCurve, const RunData*>> runs) {
  PageChart chart{fmt::format("{}/{}/time", scope, error.id),
                  first_letter_up(error.axis()),
                  fmt::format("{}: {} over time", scope, error.label),
                  {"time [s]"},
                  {error.axis(), true},
                  {}};
  for (const auto& [style, run] : runs) {
    ChartCurve curve = style;
    curve.points = above_zero(thinned(run->errors.t_s, error.values_of(*run), kMaxComparedPoints));
    if (!curve.points.x.empty()) chart.curves.push_back(std::move(curve));
  }
  return chart;
}

}  // namespace saccade
