#include "eval/report/leaderboard_section.h"

#include <fmt/format.h>

#include <algorithm>

#include "eval/configuration_name.h"
#include "eval/published_rows.h"
#include "eval/report/leaderboard.h"

namespace saccade {
namespace {

LeaderboardEntry run_entry(const RunData& data) {
  const RunRecord& record = data.run.record;
  const std::string method =
      record.external ? record.external->name : record.module + " " + configuration_name(record);
  return {method, data.dataset, data.metrics, record.problem(), ""};
}

LeaderboardEntry published_entry(const PublishedRow& row) {
  LeaderboardEntry entry{row.method + " (published)", row.sequence, {}, "", row.citation};
  entry.metrics.set(row.metric, row.value);
  return entry;
}

}  // namespace

std::vector<ReportTable> leaderboard_tables(std::span<const RunData> runs,
                                            const std::filesystem::path& published) {
  std::vector<LeaderboardEntry> entries;
  for (const RunData& data : runs) entries.push_back(run_entry(data));
  if (!published.empty())
    for (const PublishedRow& row : read_published_rows(published))
      if (std::any_of(runs.begin(), runs.end(),
                      [&](const RunData& data) { return data.dataset == row.sequence; }))
        entries.push_back(published_entry(row));
  std::vector<ReportTable> tables;
  for (const Leaderboard& board : leaderboards(entries)) tables.push_back(leaderboard_table(board));
  return tables;
}

std::string leaderboard_section(std::span<const ReportTable> tables) {
  if (tables.empty()) return "";
  std::string html =
      "<section id=\"leaderboard\"><h2>Leaderboard</h2>\n"
      "<p>Methods against sequences; runs that differ in the seed alone are pooled. Below a mean "
      "its 95 % interval. The overall score is the geometric mean over the sequences; ranked are "
      "methods that have all of them and failed on none. Bold: the best of a column.</p>\n";
  for (const ReportTable& table : tables) html += table_html(table);
  return html + "</section>\n";
}

}  // namespace saccade
