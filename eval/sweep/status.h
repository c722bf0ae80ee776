#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "eval/sweep/plan/plan.h"
#include "eval/sweep/plan/sweep_config.h"

namespace saccade {

/// Numbers of jobs.
struct JobCounts {
  std::size_t done = 0, running = 0, failed = 0, waiting = 0;

  [[nodiscard]] std::size_t all() const { return done + running + failed + waiting; }
};

/// How far a sweep is, whichever program fills its folder and wherever its jobs run.
struct SweepStatus {
  JobCounts jobs;
  /// The datasets, then each configuration.
  std::vector<std::pair<std::string, JobCounts>> parts;
  std::vector<std::pair<std::string, std::string>> failures;  ///< job, reason
  std::optional<double> jobs_per_s;  ///< over the last ten minutes; nullopt: fewer than two ended
  double rate_span_s = 0;            ///< over which it is known

  [[nodiscard]] bool has_ended() const { return jobs.running + jobs.waiting == 0; }
  /// At this rate; nullopt where it is not known or nothing is left.
  [[nodiscard]] std::optional<double> left_s() const;
};

/// From the files in the folder alone. A job is done where its record exists; whether the record is
/// still current is the matter of describe_sweep(). One that is held is left out: of this plan
/// (JobState::kHeld), or of an earlier program that ended (mark_held()).
[[nodiscard]] SweepStatus sweep_status(const SweepPlan& plan, const std::filesystem::path& folder);

/// The same of a sweep that another program may be filling. Throws InputError where `folder` is no
/// sweep. Writes nothing.
[[nodiscard]] SweepStatus sweep_status(const SweepConfig& sweep,
                                       const std::filesystem::path& folder);

/// Leaves in `folder` for sweep_status() why a job failed; empty: that it has not.
void mark_failed(const std::filesystem::path& folder, const SweepJob& job);

/// Leaves in `folder` which jobs of the plan are held, for good where the sweep has ended.
void mark_held(const std::filesystem::path& folder, const SweepPlan& plan);

/// Lines for a terminal: the numbers, the rate with the time left, the first failures.
[[nodiscard]] std::string status_text(const SweepStatus& status);

/// A page with the same and a bar for every part. Unless the sweep `has_ended` the browser loads it
/// again every few seconds.
[[nodiscard]] std::string status_page(const SweepStatus& status, const std::string& title,
                                      bool has_ended);

/// The jobs for another workflow manager, as JSON:
///   {"folder": DIR, "threads": N, "jobs": [{"name", "needs": [names], "output", "scores", "log",
///    "commands": [[word, ...], ...]}]}
/// in an order in which every job stands behind those that it needs. A command is to be called as
/// `saccade WORD...`. Writes nothing.
[[nodiscard]] std::string sweep_jobs_json(const SweepConfig& sweep,
                                          const std::filesystem::path& folder);

}  // namespace saccade
