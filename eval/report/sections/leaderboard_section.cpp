#include "eval/report/sections/page_sections.h"

#include <algorithm>

#include "eval/report/reference/published_rows.h"

namespace saccade {
namespace {

LeaderboardEntry run_entry(const RunData& data) {
  const RunRecord& record = data.run.record;
  return {.method = data.method,
          .sequence = data.dataset,
          .metrics = data.metrics,
          .problem = record.problem(),
          .module = record.module,
          .method_class = record.method_class,
          .threads = record.threads};
}

LeaderboardEntry published_entry(const PublishedRow& row) {
  LeaderboardEntry entry{
      .method = row.method + " (published)", .sequence = row.sequence, .source = row.citation};
  entry.metrics.set(row.metric, row.value);
  return entry;
}

}  // namespace

std::vector<Leaderboard> leaderboards_of(std::span<const RunData> runs,
                                         const std::filesystem::path& published) {
  std::vector<LeaderboardEntry> entries;
  for (const RunData& data : runs) entries.push_back(run_entry(data));
  if (!published.empty())
    for (const PublishedRow& row : read_published_rows(published))
      if (std::any_of(runs.begin(), runs.end(),
                      [&](const RunData& data) { return data.dataset == row.sequence; }))
        entries.push_back(published_entry(row));
  return leaderboards(entries);
}

std::string leaderboard_section(std::span<const Table> tables) {
  if (tables.empty()) return "";
  std::string html =
      "<section id=\"leaderboard\"><h2>Leaderboard</h2>\n"
      "<p>Methods against sequences; runs that differ in the seed alone are pooled. Below a mean "
      "its 95 % interval. Methods are ranked among those that were given the same inputs and look "
      "equally far ahead: first by the share of their runs that did not fail, then by the overall "
      "score, the geometric mean over the sequences. A trajectory whose error exceeds 1 % of the "
      "depth, or that was lost, has failed: means are over successes. Bold: the best of a column "
      "within a class.</p>\n";
  for (const Table& table : tables) html += table_html(table);
  return html + "</section>\n";
}

}  // namespace saccade
