#include "eval/report/report_content.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <optional>
#include <utility>

#include "core/check.h"
#include "core/error.h"
#include "core/process/parallel.h"
#include "core/process/progress.h"
#include "eval/report/html.h"
#include "eval/report/run_set_comparison.h"
#include "eval/report/sections/page_sections.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;

/// Those whose pictures a report of many runs shows.
std::set<const RunData*> first_of_methods(const std::vector<RunData>& runs) {
  std::set<std::pair<std::string, std::string>> seen;
  std::set<const RunData*> first;
  for (const RunData& data : runs)
    if (seen.emplace(data.dataset, data.method).second || runs.size() <= kMostDetailedRuns)
      first.insert(&data);
  return first;
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
std::vector<RunData> gather_runs(std::span<const fs::path> folders) {
  std::vector<fs::path> once;
  std::set<fs::path> seen;
  for (const fs::path& folder : folders)
    if (seen.insert(fs::weakly_canonical(folder)).second) once.push_back(folder);
  std::vector<RunData> runs(once.size());
  std::optional<Progress> progress;
  if (once.size() > 1) progress.emplace("reading", once.size(), "runs");
  parallel_for(once.size(), [&](std::size_t i) {
    runs[i] = gather_run(once[i], i + 1, once.size() <= kMostDetailedRuns);
    if (progress) progress->add(1);
  });
  if (progress) progress->finish();
  compare_with_refined(runs);
  tell_of_stale(runs);
  return runs;
}

/// Letters, digits and what else is safe in an address and a file's name of any system.
std::string file_stem(const std::string& name) {
  std::string stem;
  for (const char c : name)
    stem += std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-' ? c : '-';
  return stem.empty() ? "run" : stem;
}

/// Runs of one name in several folders are told apart by a number.
void give_own_pages(std::vector<RunData>& runs) {
  std::set<std::string> taken;
  for (RunData& data : runs) {
    const std::string stem = file_stem(data.run.name());
    std::string name = stem;
    for (int next = 2; !taken.insert(name).second; ++next) name = fmt::format("{}-{}", stem, next);
    data.address = "runs/" + name + ".html";
  }
}

std::string summary_of(const std::vector<RunData>& runs) {
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

ReportContent gather_report(std::span<const fs::path> run_folders, const ReportOptions& options,
                            RunPages pages) {
  if (run_folders.empty()) throw InputError("report", "needs at least one run folder");
  ReportContent content;
  std::vector<RunData>& runs = content.runs;
  runs = gather_runs(run_folders);
  tell_methods_apart(runs);
  if (pages == RunPages::kApart) give_own_pages(runs);
  const std::vector<RunData> before = gather_runs(options.against);
  std::optional<RunSetComparison> comparison;
  if (!before.empty()) comparison = compare_run_sets(before, runs);
  const std::vector<Leaderboard> boards = leaderboards_of(runs, options.published);
  for (const Leaderboard& board : boards) content.tables.push_back(leaderboard_table(board));
  std::vector<std::string> parts;
  if (comparison) {
    parts.push_back(against_section(*comparison, content.charts));
    content.tables.push_back(against_table(*comparison));
  }
  if (runs.size() > 1)
    parts.push_back(leaderboard_section(std::span(content.tables).first(boards.size())));
  parts.push_back(compared_section(runs, boards, content.charts));
  parts.push_back(segment_section(runs));
  parts.push_back(reliability_section(runs, content.charts));
  parts.push_back(failure_section(runs));
  for (const auto& table : {accuracy_table, depth_table, dataset_table, speed_table})
    parts.push_back(table(runs));
  content.overview = with_repeat(parts, options.command);
  content.summary = summary_of(runs);
  content.with_pictures = first_of_methods(runs);
  return content;
}

std::vector<std::vector<const RunData*>> by_dataset(std::span<const RunData> runs) {
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

std::string overview_links(const ReportContent& content) {
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
    if (content.overview.find(fmt::format("id=\"{}\"", id)) != std::string::npos)
      html += fmt::format("<a href=\"#{}\">{}</a>", id, name);
  return html;
}

std::string run_links(std::span<const RunData> runs) {
  std::string links;
  for (const RunData& data : runs)
    links += fmt::format("<a href=\"{}\">{}</a>", escape_html(data.address),
                         escape_html(data.run.name()));
  if (runs.size() <= kMostDetailedRuns) return links;
  return fmt::format("<details><summary>{} runs</summary><nav>{}</nav></details>", runs.size(),
                     links);
}

}  // namespace saccade
