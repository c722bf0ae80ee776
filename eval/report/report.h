#pragma once

#include <filesystem>
#include <span>
#include <string>

namespace saccade {

struct ReportOptions {
  std::string title = "saccade report";
  /// Scores of other methods for the leaderboard (eval/published_rows.h); empty: none.
  std::filesystem::path published;
  /// Folder for the leaderboard's tables as NAME.tex and NAME.csv; empty: none.
  std::filesystem::path exports;
};

/// Writes one HTML page about the runs that needs nothing beside it: a leaderboard where there
/// is more than one run, tables against the thesis, and for every run its trajectory in 3-D, errors
/// over time, pictures, speed and provenance. Runs are scored anew against their datasets; where a
/// dataset is gone, the page shows what metrics.json holds. At least one run. Throws InputError for
/// a folder that is no run.
void write_report(std::span<const std::filesystem::path> run_folders,
                  const std::filesystem::path& output, const ReportOptions& options = {});

}  // namespace saccade
