#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "eval/report/run_data.h"

namespace saccade {

/// A run of a published report.
struct PublishedRun {
  std::string name;
  std::string page;  ///< address from the report's folder, "runs/walls_best.html"
  std::string method;
  std::string module;
  std::string dataset;
  std::string commit;  ///< "1234567890ab"; the version where there is none
  std::uint64_t seed = 0;
  std::string problem;                   ///< why it came to nothing; empty where all is well
  std::map<std::string, double> scores;  ///< of the metrics that have a leaderboard
};

/// What a site knows of one of its reports: scores.json in the report's folder.
struct PublishedReport {
  std::string name;  ///< of its folder, part of its address for good
  std::string title;
  std::string published;  ///< UTC, "2026-01-31T12:00:00Z"
  std::string version;    ///< of the program that wrote it
  std::vector<PublishedRun> runs;
};

inline constexpr std::string_view kPublishedScores = "scores.json";

/// The report of these runs. Its name is the title with a hash of title and runs, so that the same
/// report published again replaces itself and no other.
[[nodiscard]] PublishedReport published_report(const std::vector<RunData>& runs,
                                               const std::string& title);

[[nodiscard]] std::string to_json(const PublishedReport& report);

/// The report in `folder`. InputError with the file where it is missing or malformed.
[[nodiscard]] PublishedReport read_published_report(const std::filesystem::path& folder);

/// All reports below `site`/reports, in the order in which they were published. A folder without
/// scores.json is none. InputError as read_published_report().
[[nodiscard]] std::vector<PublishedReport> read_published_reports(
    const std::filesystem::path& site);

}  // namespace saccade
