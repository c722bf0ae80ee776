#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "eval/metrics/metrics.h"
#include "eval/sweep/plan/plan.h"

namespace saccade {

/// What became of a job.
enum class JobState { kUnknown, kDone, kSkipped, kFailed };

/// By the job's index in the plan.
struct SweepStates {
  std::vector<JobState> simulations;
  std::vector<JobState> runs;
};

/// A job with what it gave.
struct SweepRow {
  const SweepJob* job;
  bool failed = false;
  Metrics metrics;      ///< of metrics.json, or facts of the dataset ("dataset.events")
  std::string machine;  ///< it ran on; empty where unknown
  std::string tool_version;
  /// Why an external program has no poses; the job itself did what it should.
  std::string problem = {};
};

/// Reads what the jobs that did not fail left behind.
[[nodiscard]] std::vector<SweepRow> read_rows(const std::vector<SweepJob>& jobs,
                                              const std::vector<JobState>& states);

/// The rows that differ in nothing but seeds, in the order of the plan.
struct SweepGroup {
  SweepPoint point;  ///< of the first
  std::vector<const SweepRow*> rows;
};
[[nodiscard]] std::vector<SweepGroup> group_by_seed(const std::vector<SweepRow>& rows);

/// Over the rows of a group that have the metric and no problem.
struct MetricSummary {
  double value = 0;  ///< mean, or median of a speed
  double low = 0;
  double high = 0;
  std::size_t count = 0;
};
/// nullopt where no row has it. A `key` without a value stands for key.median.
[[nodiscard]] std::optional<MetricSummary> summarise(const SweepGroup& group,
                                                     const std::string& key);

/// What the table and the pictures show of a sweep.
struct SweepResults {
  const SweepConfig& sweep;
  const SweepPlan& plan;
  std::vector<SweepRow> rows;
  std::vector<SweepGroup> groups;
  std::vector<std::string> metrics;  ///< keys: the sweep's own, or those of the usual ones it has
};
[[nodiscard]] SweepResults collect_results(const SweepConfig& sweep, const SweepPlan& plan,
                                           const SweepStates& states);

/// Writes FOLDER/sweep.csv (a row for each job, all its metrics), FOLDER/sweep.md (a row for each
/// group, `metrics`, and what became of the expected figures) and FOLDER/*.png. How many expected
/// figures were missed.
std::size_t write_sweep_results(const SweepConfig& sweep, const SweepPlan& plan,
                                const SweepStates& states, const std::filesystem::path& folder);

}  // namespace saccade
