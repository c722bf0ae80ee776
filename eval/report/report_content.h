#pragma once

#include <filesystem>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "eval/report/charts/page_chart.h"
#include "eval/report/report.h"
#include "eval/report/run_data.h"
#include "eval/table/table.h"

namespace saccade {

/// Reports of more runs keep what they say of a run small: pictures of a method's first run on each
/// dataset alone, since those of all seeds would be most of the time and of the page, and for the
/// same reason no chart of the reprojection error.
inline constexpr std::size_t kMostDetailedRuns = 40;

/// Where the sections of the runs are.
enum class RunPages {
  kTogether,  ///< on the page of the report: RunData::address is "#ID"
  kApart,     ///< each on its own: "runs/NAME.html"
};

/// What is said about some runs, before it is known on how many pages it stands.
struct ReportContent {
  std::vector<RunData> runs;
  std::string summary;            ///< HTML, a sentence
  std::string overview;           ///< HTML: all sections but those of single runs
  std::vector<PageChart> charts;  ///< of the overview
  std::vector<Table> tables;      ///< the leaderboards, and A against B
  /// Those whose pictures are shown.
  std::set<const RunData*> with_pictures;
};

/// Reads, scores where scores are stale, and compares the runs as write_report() says. Throws as it
/// does.
[[nodiscard]] ReportContent gather_report(std::span<const std::filesystem::path> run_folders,
                                          const ReportOptions& options, RunPages pages);

/// The runs grouped by dataset, both in the order in which they first come.
[[nodiscard]] std::vector<std::vector<const RunData*>> by_dataset(std::span<const RunData> runs);

/// Links to the parts of the overview that are there.
[[nodiscard]] std::string overview_links(const ReportContent& content);

/// A link to every run.
[[nodiscard]] std::string run_links(std::span<const RunData> runs);

}  // namespace saccade
