#include "eval/sweep/result/failures.h"

#include <fmt/format.h>

#include <algorithm>

#include "eval/table/table.h"

namespace saccade {
namespace {

/// A page is read from its top: more stand in sweep.csv.
constexpr std::size_t kMostReasons = 40;

/// Of one configuration.
struct FailureCounts {
  std::string configuration;
  std::size_t runs = 0, came_to_nothing = 0, lost = 0;
};

std::vector<FailureCounts> count_failures(const SweepResults& results) {
  std::vector<FailureCounts> counts;
  for (const SweepRow& row : results.rows) {
    const std::string& name = row.job->point.configuration;
    auto known = std::find_if(counts.begin(), counts.end(), [&](const FailureCounts& count) {
      return count.configuration == name;
    });
    if (known == counts.end()) known = counts.insert(counts.end(), {.configuration = name});
    ++known->runs;
    known->came_to_nothing += row.outcome().has_failed ? 1 : 0;
    known->lost += !row.outcome().has_failed && was_lost(row.metrics) ? 1 : 0;
  }
  return counts;
}

std::string counts_table(const std::vector<FailureCounts>& counts) {
  Table table{.columns = {{"configuration"}}};
  table.add_numeric({"runs", "without a result", "lost"});
  for (const FailureCounts& count : counts)
    if (count.came_to_nothing + count.lost > 0)
      table.add({count.configuration, std::to_string(count.runs),
                 std::to_string(count.came_to_nothing), std::to_string(count.lost)});
  return table_markdown(table) + "\n";
}

}  // namespace

std::string status_of(const SweepRow& row) {
  if (row.failed && row.problem.empty()) return "failed";
  if (!row.problem.empty()) return row.problem.substr(0, row.problem.find(':'));
  return was_lost(row.metrics) ? "lost" : "ok";
}

std::string reason_of(const SweepRow& row) {
  if (row.failed && row.problem.empty()) return "failed";
  const bool is_failure = row.outcome().has_failed || was_lost(row.metrics);
  return is_failure ? failure_text(row.metrics, row.problem) : "";
}

std::string failures_section(const SweepResults& results) {
  std::size_t failed = 0, lost = 0;
  const std::vector<FailureCounts> counts = count_failures(results);
  for (const FailureCounts& count : counts) {
    failed += count.came_to_nothing;
    lost += count.lost;
  }
  if (failed + lost == 0) return "";
  std::string text =
      fmt::format("## Failures\n{} of {} {} without a result, {} lost.\n\n", failed,
                  results.rows.size(), results.plan.runs.empty() ? "datasets" : "runs", lost);
  if (counts.size() > 1) text += counts_table(counts);
  std::size_t shown = 0;
  for (const SweepRow& row : results.rows) {
    const std::string reason = reason_of(row);
    if (reason.empty() || ++shown > kMostReasons) continue;
    text += fmt::format("- {}: {}{}\n", row.job->name, reason,
                        row.failed ? " (jobs/" + row.job->name + "/log.txt)" : "");
  }
  if (shown > kMostReasons)
    text += fmt::format("- and {} more, in sweep.csv\n", shown - kMostReasons);
  return text + "\n";
}

}  // namespace saccade
