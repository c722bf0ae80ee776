#include "eval/report/sections/page_sections.h"

#include <algorithm>

#include "eval/report/reference/published_rows.h"

namespace saccade {
namespace {

LeaderboardEntry run_entry(const RunData& data) {
  return {data.method, data.dataset, data.metrics, data.run.record.problem(), ""};
}

LeaderboardEntry published_entry(const PublishedRow& row) {
  LeaderboardEntry entry{row.method + " (published)", row.sequence, {}, "", row.citation};
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
      "its 95 % interval. The overall score is the geometric mean over the sequences; ranked are "
      "methods that have all of them and failed on none. Bold: the best of a column.</p>\n";
  for (const Table& table : tables) html += table_html(table);
  return html + "</section>\n";
}

}  // namespace saccade
