#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "eval/report/charts/page_chart.h"
#include "eval/report/run_data.h"

namespace saccade {

/// An error of the pose that runs have over time.
struct TimedError {
  std::string id;
  std::string label;
  std::string unit;
  double scale = 1;  ///< from the series to the unit
  std::vector<double> ErrorSeries::*series = nullptr;

  /// [unit]
  [[nodiscard]] std::vector<double> values_of(const RunData& run) const;
  /// "rotation error [deg]"
  [[nodiscard]] std::string axis() const;
};

/// Of the position, relative to the sequence's mean depth where all of the runs know that, and the
/// rotation.
[[nodiscard]] std::vector<TimedError> timed_errors(std::span<const RunData* const> runs);

/// One chart of the error of several runs of `scope`, each in its style; over a logarithmic axis,
/// since methods differ by factors. Runs without the error are left out.
[[nodiscard]] PageChart chart_over_time(
    const TimedError& error, const std::string& scope,
    std::span<const std::pair<ChartCurve, const RunData*>> runs);

}  // namespace saccade
