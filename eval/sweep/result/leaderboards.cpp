#include "eval/sweep/result/leaderboards.h"

#include <set>

#include "eval/report/leaderboard.h"
#include "eval/sweep/result/failures.h"
#include "eval/table/table.h"

namespace saccade {
namespace {

/// The datasets of several seeds are one sequence, generated ones are not.
std::string sequence_of(const SweepPoint& point, const std::filesystem::path& dataset) {
  return point.is_generated ? dataset.filename().string() : point.dataset;
}

std::vector<LeaderboardEntry> entries_of(const SweepResults& results) {
  std::vector<LeaderboardEntry> entries;
  for (const SweepRow& row : results.rows) {
    const SweepPoint& point = row.job->point;
    entries.push_back({.method = point.configuration,
                       .sequence = sequence_of(point, row.job->dataset),
                       .metrics = row.metrics,
                       .problem = row.outcome().has_failed ? reason_of(row) : "",
                       .module = point.module,
                       .method_class = row.method_class,
                       .threads = row.threads});
  }
  return entries;
}

bool is_ranked(const SweepResults& results) {
  const SweepConfig& sweep = results.sweep;
  if (sweep.configurations.size() < 2 || !sweep.grid.empty() || !sweep.variants.empty())
    return false;
  std::set<std::filesystem::path> datasets;
  for (const SweepRow& row : results.rows) datasets.insert(row.job->dataset);
  return datasets.size() > 1;
}

}  // namespace

std::string sweep_leaderboards(const SweepResults& results) {
  if (!is_ranked(results)) return "";
  std::string text;
  for (const Leaderboard& board : leaderboards(entries_of(results))) {
    if (board.key.starts_with("speed.")) continue;  // a column of all others
    const Table table = leaderboard_table(board);
    text += "### " + table.caption + "\n" + table_markdown(table) + "\n";
  }
  if (text.empty()) return "";
  return "## Leaderboard\nConfigurations are ranked among those that were given the same inputs "
         "and "
         "look equally far ahead: first by the share of their runs that did not fail, then by the "
         "geometric mean over the datasets. A trajectory whose error exceeds 1 % of the depth, or "
         "that was lost, has failed: means are over successes. Bold: the best of a column within a "
         "class.\n\n" +
         text;
}

}  // namespace saccade
