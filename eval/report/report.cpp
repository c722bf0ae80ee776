#include "eval/report/report.h"

#include <fmt/format.h>

#include <vector>

#include "core/error.h"
#include "core/io/atomic_file.h"
#include "core/version.h"
#include "eval/report/assets.h"
#include "eval/report/html.h"
#include "eval/report/leaderboard_section.h"
#include "eval/report/run_data.h"
#include "eval/report/run_section.h"
#include "eval/report/run_series.h"
#include "eval/report/tables.h"

namespace saccade {
namespace {

/// The runs grouped by dataset, both in the order in which they first come.
std::vector<std::vector<const RunData*>> by_dataset(const std::vector<RunData>& runs) {
  std::vector<std::vector<const RunData*>> groups;
  for (const RunData& data : runs) {
    bool found = false;
    for (auto& group : groups)
      if (group.front()->dataset == data.dataset) {
        group.push_back(&data);
        found = true;
        break;
      }
    if (!found) groups.push_back({&data});
  }
  return groups;
}

std::string sections(const std::vector<RunData>& runs) {
  std::string html;
  for (const auto& group : by_dataset(runs)) {
    html += fmt::format("<h2>{}</h2>\n", escape_html(group.front()->dataset));
    html += dataset_pictures(*group.front());
    for (const RunData* data : group) html += run_section(*data);
  }
  return html;
}

/// Links to the tables that are there and to every run.
std::string contents(const std::vector<RunData>& runs, const std::string& tables) {
  std::string html;
  for (const auto& [id, name] : {std::pair{"leaderboard", "Leaderboard"},
                                 {"accuracy", "Accuracy"},
                                 {"depth", "Depth"},
                                 {"datasets", "Datasets"},
                                 {"speed", "Speed"}})
    if (tables.find(fmt::format("id=\"{}\"", id)) != std::string::npos)
      html += fmt::format("<a href=\"#{}\">{}</a>", id, name);
  for (const RunData& data : runs)
    html += fmt::format("<a href=\"#{}\">{}</a>", data.id, escape_html(data.run.name()));
  return html;
}

}  // namespace

void write_report(std::span<const std::filesystem::path> run_folders,
                  const std::filesystem::path& output, const ReportOptions& options) {
  if (run_folders.empty()) throw InputError("report", "needs at least one run folder");
  std::vector<RunData> runs;
  for (const std::filesystem::path& folder : run_folders)
    runs.push_back(gather_run(folder, runs.size() + 1));
  compare_with_refined(runs);
  const std::vector<ReportTable> boards = leaderboard_tables(runs, options.published);
  const std::string tables = (runs.size() > 1 ? leaderboard_section(boards) : "") +
                             accuracy_table(runs) + depth_table(runs) + dataset_table(runs) +
                             speed_table(runs);
  const std::string page = fill_page(
      assets::page_html,
      {{"title", escape_html(options.title)},
       {"summary",
        fmt::format("{} {} scored against ground truth, beside the numbers of the thesis "
                    "(T. Horstschaefer, University of Zurich, 2016).",
                    runs.size(), runs.size() == 1 ? "run" : "runs")},
       {"contents", contents(runs, tables)},
       {"style", std::string(assets::report_css)},
       {"body", tables + sections(runs)},
       {"data", run_series(runs)},
       {"script", std::string(assets::report_js)},
       {"footer",
        fmt::format("Written by saccade {} ({}). Definitions of all scores: docs/metrics.md.",
                    version(), git_commit())}});
  write_atomically(output, page);
  if (!options.exports.empty()) export_tables(boards, options.exports);
}

}  // namespace saccade
