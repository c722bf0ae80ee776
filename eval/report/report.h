#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace saccade {

struct ReportOptions {
  std::string title = "saccade report";
  std::string command;  ///< command line that makes the page, for its readers; empty: not stated
  /// Scores of other methods for the leaderboard (eval/report/reference/published_rows.h); empty:
  /// none.
  std::filesystem::path published;
  /// Run folders that did the same work before, or with another configuration
  /// (eval/report/run_set_comparison.h); empty: none.
  std::vector<std::filesystem::path> against;
  bool film = false;  ///< a short film of every run
  /// Folder for the tables of the leaderboard and of `against` as NAME.tex and NAME.csv; empty:
  /// none.
  std::filesystem::path exports;
};

/// Writes one HTML page about the runs that needs nothing beside it: a leaderboard where there
/// is more than one run, methods against each other in charts, the runs against others, tables
/// against the thesis, and for every run its trajectory in 3-D, errors over time, pictures, speed
/// and provenance. The scores are those that evaluate_run() wrote; a run whose scores are missing
/// or stale (eval/score_inputs.h) is scored again, and a notice says so. Where a dataset is gone,
/// the page shows what metrics.json holds. At least one run; a folder that is named twice is shown
/// once. Throws InputError for a folder that is no run, or where none of the runs has a partner
/// among the others.
void write_report(std::span<const std::filesystem::path> run_folders,
                  const std::filesystem::path& output, const ReportOptions& options = {});

}  // namespace saccade
