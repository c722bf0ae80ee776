#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/io/run/method_class.h"
#include "eval/information/information.h"
#include "eval/metrics/metrics.h"
#include "eval/metrics/outcome.h"
#include "eval/sweep/plan/halving.h"
#include "eval/sweep/plan/plan.h"

namespace saccade {

/// A job with its result.
struct SweepRow {
  const SweepJob* job = nullptr;
  bool failed = false;
  Metrics metrics;      ///< of metrics.json, or properties of the dataset ("dataset.events")
  std::string machine;  ///< empty where unknown
  std::string tool_version;
  /// Why there is no result: what the failed job says, or how an external program ended, whose job
  /// itself succeeded. Empty where there is one.
  std::string problem = {};
  std::optional<MethodClass> method_class = {};  ///< nullopt: not known
  int threads = 0;                               ///< 0: not known
  std::optional<Information> information = {};   ///< of its generated dataset; nullopt: not known

  [[nodiscard]] RunOutcome outcome() const {
    return {metrics.get("success"), failed || !problem.empty()};
  }
};

/// Rows that differ in their seeds alone, in the order of the plan.
struct SweepGroup {
  SweepPoint point;  ///< of the first
  std::vector<const SweepRow*> rows;
};
[[nodiscard]] std::vector<SweepGroup> group_by_seed(const std::vector<SweepRow>& rows);

/// A metric over the rows of a group that have it and no problem.
struct MetricSummary {
  double value = 0;  ///< mean; of a speed, and over generated datasets, the median
  double low = 0;    ///< minimum; over generated datasets the lower quartile; of `success` Wilson's
                     ///< 95 % interval
  double high = 0;
  std::size_t count = 0;
};
/// nullopt where no row has the metric. `success` is the share of all rows: one that failed did not
/// succeed. A `key` without a value stands for key.median.
[[nodiscard]] std::optional<MetricSummary> summarise(const SweepGroup& group,
                                                     const std::string& key);

/// success_share() of the rows.
[[nodiscard]] std::optional<SuccessShare> success_of(std::span<const SweepRow* const> rows);

/// The input of the tables and charts of a sweep.
struct SweepResults {
  const SweepConfig& sweep;
  const SweepPlan& plan;
  std::vector<SweepRow> rows;
  std::vector<SweepGroup> groups;
  std::vector<std::string> metrics;  ///< keys that the sweep states, or the usual ones that it has
  std::vector<StoppedRow> stopped = {};  ///< rows that halving stopped
};

/// An expected metric and its value on one dataset.
struct ExpectationResult {
  const ExpectedMetric* expected;
  std::string dataset;
  std::optional<double> value;  ///< over all seeds; nullopt where nothing was measured
  bool met = false;             ///< false without a value, and where the run of a seed failed
};

/// One result per expected metric and group of its configuration.
[[nodiscard]] std::vector<ExpectationResult> check_expectations(const SweepResults& results);

/// Writes FOLDER/sweep.csv (one row per job with all its metrics), of generated datasets
/// FOLDER/information.csv (dataset_information.h), FOLDER/sweep.md (what failed, one
/// row per group with `metrics`, the leaderboard, and the expected metrics) and FOLDER/*.png.
/// Returns the number of expected metrics that were missed.
/// `stopped`: rows of which some runs were never made.
std::size_t write_sweep_results(const SweepConfig& sweep, const SweepPlan& plan,
                                const std::vector<StoppedRow>& stopped,
                                const std::filesystem::path& folder);

}  // namespace saccade
