#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "eval/metrics/metrics.h"

namespace saccade {

/// Everything that tables, figures, the leaderboard and the gate know about a metric.
struct MetricInfo {
  enum class Better { kNeither, kLower, kHigher };

  std::string key;         ///< in metrics.json; '*' in the catalogue stands for any text
  std::string label = {};  ///< heading of its column, with the unit; the key where it has none
  std::string unit = {};   ///< of the stored value; empty: a number without a unit
  /// From the stored value to what people are shown: 100 for a fraction in percent, 1000 for
  /// millimetres and milliseconds.
  double scale = 1;
  Better better = Better::kLower;
  std::string needs = {};  ///< what the run and the dataset must hold for it
  /// The gate judges the metric and adds this to both values of a ratio: changes far below it do
  /// not count, and 0 has a logarithm. In the metric's unit, above 0; nullopt: not judged unless
  /// asked for.
  std::optional<double> floor = {};
  std::optional<double> tolerance = {};  ///< smallest relative change; nullopt: --tolerance
  std::string board = {};   ///< title of its leaderboard, without the unit; empty: it has none
  bool in_tables = false;   ///< a column where a table's reader named none
  bool in_figures = false;  ///< drawn where a sweep names no metrics
  bool is_speed = false;    ///< summarised by the median: its spread says nothing of the method

  [[nodiscard]] bool higher_is_better() const { return better == Better::kHigher; }
  /// Unit of scale * value.
  [[nodiscard]] std::string shown_unit() const;
};

/// One row per metric, or per family of metrics that differ in a part of the key, in the order in
/// which tables show them. The only place that says how a metric is called, shown and judged.
[[nodiscard]] std::span<const MetricInfo> metric_catalogue();

/// The row of `key` with the wildcards filled in: the row of that very key, else the first whose
/// pattern it matches. A key that the catalogue does not have is its own label, and an error of
/// which less is better.
[[nodiscard]] MetricInfo metric_info(std::string_view key);

/// Whether a row has that very key or a pattern that it matches.
[[nodiscard]] bool is_catalogued(std::string_view key);

/// The same metrics. Every score has a row, which says how it is called, shown and judged
/// (contract); what "speed." is followed by stands in the timing.json of a run.
[[nodiscard]] Metrics catalogued(Metrics metrics);

/// The metrics that tables show where their reader named none, in their order.
[[nodiscard]] std::span<const MetricInfo> default_metrics();

/// The value at `key` times the scale of its row, as people are shown it; nullopt where it was not
/// measured.
[[nodiscard]] std::optional<double> shown_value(const Metrics& metrics, const std::string& key);

}  // namespace saccade
