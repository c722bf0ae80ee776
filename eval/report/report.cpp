#include "eval/report/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

#include "core/check.h"
#include "core/error.h"
#include "core/io/files/atomic_file.h"
#include "core/process/parallel.h"
#include "core/process/progress.h"
#include "core/version.h"
#include "eval/report/assets.h"
#include "eval/report/charts/page_data.h"
#include "eval/report/html.h"
#include "eval/report/run_data.h"
#include "eval/report/sections/page_sections.h"

namespace saccade {
namespace {

/// Pages of more runs keep the sections of their runs compressed, and have pictures of a method's
/// first run on each dataset alone: those of all seeds would be most of the time and of the page.
/// They have no chart of the reprojection error, for the same reason.
constexpr std::size_t kMostUnpackedRuns = 40;

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

std::string dataset_heading(const RunData& data) {
  return fmt::format("<h2>{}</h2>\n", escape_html(data.dataset)) + dataset_pictures(data);
}

/// Those whose pictures a page of many runs shows.
std::set<const RunData*> first_of_methods(const std::vector<RunData>& runs) {
  std::set<std::pair<std::string, std::string>> seen;
  std::set<const RunData*> first;
  for (const RunData& data : runs)
    if (seen.emplace(data.dataset, data.method).second) first.insert(&data);
  return first;
}

std::string framed_section(const RunData& data, const std::string& content, bool packed) {
  return fmt::format("<section id=\"{}\" class=\"run\"><h3>{}</h3>\n", data.id,
                     escape_html(data.run.name())) +
         (packed ? packed_html(content) : content) + "</section>\n";
}

std::string sections(const std::vector<RunData>& runs, bool film) {
  std::vector<std::pair<const RunData*, bool>> order;  // whether it is a dataset's first
  for (const auto& group : by_dataset(runs))
    for (const RunData* data : group) order.emplace_back(data, data == group.front());
  const bool packed = runs.size() > kMostUnpackedRuns;
  const std::set<const RunData*> first = first_of_methods(runs);
  std::vector<std::string> parts(order.size());
  // Films show their own progress and are encoded with all threads: one after the other.
  std::optional<Progress> progress;
  if (order.size() > 1 && !film) progress.emplace("drawing", order.size(), "runs");
  const auto draw = [&](std::size_t i) {
    const auto& [data, is_first] = order[i];
    const RunSectionParts content{!packed || first.contains(data), film};
    parts[i] = (is_first ? dataset_heading(*data) : "") +
               framed_section(*data, run_section(*data, content), packed);
    if (progress) progress->add(1);
  };
  parallel_for(order.size(), draw, film ? order.size() : 1);
  return fmt::format("{}", fmt::join(parts, ""));
}

/// Links to the tables that are there and to every run.
std::string contents(const std::vector<RunData>& runs, const std::string& tables) {
  std::string html;
  for (const auto& [id, name] : {std::pair{"against", "A against B"},
                                 {"leaderboard", "Leaderboard"},
                                 {"compared", "Compared"},
                                 {"segments", "Segments"},
                                 {"reliability", "Reliability"},
                                 {"failures", "Failures"},
                                 {"accuracy", "Accuracy"},
                                 {"depth", "Depth"},
                                 {"datasets", "Datasets"},
                                 {"speed", "Speed"}})
    if (tables.find(fmt::format("id=\"{}\"", id)) != std::string::npos)
      html += fmt::format("<a href=\"#{}\">{}</a>", id, name);
  std::string links;
  for (const RunData& data : runs)
    links += fmt::format("<a href=\"#{}\">{}</a>", data.id, escape_html(data.run.name()));
  if (runs.size() <= kMostUnpackedRuns) return html + links;
  return html + fmt::format("<details><summary>{} runs</summary><nav>{}</nav></details>",
                            runs.size(), links);
}

/// One line for all runs that were scored again.
void tell_of_stale(std::span<const RunData> runs) {
  const auto is_stale = [](const RunData& data) { return !data.stale.empty(); };
  const auto first = std::find_if(runs.begin(), runs.end(), is_stale);
  if (first == runs.end()) return;
  show_notice(
      fmt::format("scored again: {} of {} runs, since their scores were missing or stale "
                  "({}: {})",
                  std::count_if(runs.begin(), runs.end(), is_stale), runs.size(), first->run.name(),
                  first->stale));
}

/// A run that patterns of a shell name twice is one run, not two of a kind.
std::vector<RunData> gather_runs(std::span<const std::filesystem::path> folders) {
  std::vector<std::filesystem::path> once;
  std::set<std::filesystem::path> seen;
  for (const std::filesystem::path& folder : folders)
    if (seen.insert(std::filesystem::weakly_canonical(folder)).second) once.push_back(folder);
  std::vector<RunData> runs(once.size());
  std::optional<Progress> progress;
  if (once.size() > 1) progress.emplace("reading", once.size(), "runs");
  parallel_for(once.size(), [&](std::size_t i) {
    runs[i] = gather_run(once[i], i + 1, once.size() <= kMostUnpackedRuns);
    if (progress) progress->add(1);
  });
  if (progress) progress->finish();
  compare_with_refined(runs);
  tell_of_stale(runs);
  return runs;
}

std::string summary(const std::vector<RunData>& runs) {
  return fmt::format(
      "{} {} scored against ground truth, beside the numbers of the thesis (T. Horstschaefer, "
      "University of Zurich, 2016).",
      runs.size(), runs.size() == 1 ? "run" : "runs");
}

/// The parts, each with the command that makes the page at its end.
std::string with_repeat(const std::vector<std::string>& parts, const std::string& command) {
  constexpr std::string_view kEnd = "</section>\n";
  std::string html;
  for (const std::string& part : parts) {
    if (part.empty()) continue;
    SACCADE_CHECK(part.ends_with(kEnd));
    html += part.substr(0, part.size() - kEnd.size());
    html += repeat_html({command}) + std::string(kEnd);
  }
  return html;
}

}  // namespace

void write_report(std::span<const std::filesystem::path> run_folders,
                  const std::filesystem::path& output, const ReportOptions& options) {
  if (run_folders.empty()) throw InputError("report", "needs at least one run folder");
  std::vector<RunData> runs = gather_runs(run_folders);
  tell_methods_apart(runs);
  const std::vector<RunData> before = gather_runs(options.against);
  std::optional<RunSetComparison> comparison;
  if (!before.empty()) comparison = compare_run_sets(before, runs);
  const std::vector<Leaderboard> boards = leaderboards_of(runs, options.published);
  std::vector<Table> exported;
  for (const Leaderboard& board : boards) exported.push_back(leaderboard_table(board));
  std::vector<PageChart> charts;
  std::vector<std::string> parts;
  if (comparison) {
    parts.push_back(against_section(*comparison, charts));
    exported.push_back(against_table(*comparison));
  }
  if (runs.size() > 1)
    parts.push_back(leaderboard_section(std::span(exported).first(boards.size())));
  parts.push_back(compared_section(runs, boards, charts));
  parts.push_back(segment_section(runs));
  parts.push_back(reliability_section(runs, charts));
  parts.push_back(failure_section(runs));
  for (const auto& table : {accuracy_table, depth_table, dataset_table, speed_table})
    parts.push_back(table(runs));
  const std::string tables = with_repeat(parts, options.command);
  const std::string page = fill_page(
      assets::page_html,
      {{"title", escape_html(options.title)},
       {"summary", summary(runs)},
       {"contents", contents(runs, tables)},
       {"style", std::string(assets::report_css)},
       {"body", tables + sections(runs, options.film)},
       {"charts", charts_data(charts)},
       {"script", std::string(assets::report_js)},
       {"footer",
        fmt::format("Written by saccade {} ({}). Definitions of all scores: docs/metrics.md.",
                    version(), git_commit())}});
  write_atomically(output, page);
  if (!options.exports.empty()) export_tables(exported, options.exports);
}

}  // namespace saccade
