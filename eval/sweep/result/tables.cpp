#include "eval/sweep/result/tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <set>
#include <utility>

#include "eval/metrics/catalogue.h"
#include "eval/sweep/result/ablation.h"
#include "eval/sweep/result/dataset_information.h"
#include "eval/sweep/result/failures.h"
#include "eval/sweep/result/leaderboards.h"
#include "eval/sweep/result/pooled_table.h"
#include "eval/sweep/result/stopped_rows.h"
#include "eval/table/number_text.h"
#include "eval/table/table.h"

namespace saccade {
namespace {

using Better = MetricInfo::Better;

CsvTable::Cell seed_cell(const std::optional<std::uint64_t>& seed) {
  if (!seed) return std::string();
  return std::to_string(*seed);
}

/// Whether any row of the tables averages over seeds.
bool has_seeds(const SweepResults& results) {
  return std::any_of(results.groups.begin(), results.groups.end(),
                     [](const SweepGroup& group) { return group.rows.size() > 1; });
}

std::vector<Table::Column> header(const SweepResults& results, bool with_dataset,
                                  const std::vector<std::string>& metrics) {
  std::vector<Table::Column> columns;
  if (with_dataset) columns.push_back({"dataset"});
  if (results.sweep.configurations.size() > 1) columns.push_back({"configuration"});
  if (!results.sweep.variants.empty()) columns.push_back({"variant"});
  for (const std::string& axis : results.plan.axes) columns.push_back({"`" + axis + "`"});
  if (has_seeds(results)) columns.push_back({results.sweep.generate ? "datasets" : "seeds"});
  for (const std::string& metric : metrics) columns.push_back({metric_info(metric).label, true});
  return columns;
}

bool was_lost(const SweepGroup& group) {
  const std::optional<MetricSummary> lost_s = summarise(group, "trajectory.lost_s");
  return lost_s && lost_s->high > 0;
}

/// The best value of a metric among the rows of a table; nullopt where all are equal. The speed of
/// an estimator that lost track does not count.
std::optional<double> best_of(const std::vector<const SweepGroup*>& groups,
                              const std::string& metric) {
  const MetricInfo info = metric_info(metric);
  std::set<double> all, eligible;
  for (const SweepGroup* group : groups)
    if (const auto summary = summarise(*group, metric)) {
      all.insert(summary->value);
      if (!info.is_speed || !was_lost(*group)) eligible.insert(summary->value);
    }
  if (all.size() < 2 || eligible.empty() || info.better == Better::kNeither) return std::nullopt;
  return info.better == Better::kLower ? *eligible.begin() : *eligible.rbegin();
}

std::string value_cell(const SweepGroup& group, const std::string& metric,
                       const std::optional<double>& best) {
  const std::optional<MetricSummary> summary = summarise(group, metric);
  if (!summary) return rounded(std::nullopt);
  std::string text = rounded(summary->value);
  if (best && summary->value == *best) text = "**" + text + "**";
  // Of a single run the interval of its success says nothing.
  const bool has_spread = summary->low < summary->high && summary->count > 1;
  if (has_spread && !metric_info(metric).is_speed)
    text += fmt::format(" ({}–{})", rounded(summary->low), rounded(summary->high));
  return text;
}

/// `best`: by the metric's key.
std::vector<std::string> body(
    const SweepResults& results, bool with_dataset, const SweepGroup& group,
    const std::vector<std::pair<std::string, std::optional<double>>>& best) {
  std::vector<std::string> cells;
  if (with_dataset) cells.push_back(group.point.dataset);
  if (results.sweep.configurations.size() > 1) cells.push_back(group.point.configuration);
  if (!results.sweep.variants.empty()) cells.push_back(group.point.variant);
  cells.insert(cells.end(), group.point.grid.begin(), group.point.grid.end());
  const auto failed = std::count_if(group.rows.begin(), group.rows.end(),
                                    [](const SweepRow* row) { return row->outcome().has_failed; });
  if (has_seeds(results))
    cells.push_back(failed == 0 ? std::to_string(group.rows.size())
                                : fmt::format("{} ({} failed)", group.rows.size(), failed));
  for (const auto& [metric, value] : best) cells.push_back(value_cell(group, metric, value));
  return cells;
}

using Groups = std::vector<const SweepGroup*>;

/// The metrics that a row of the table has: modules have different metrics.
std::vector<std::string> measured_of(const SweepResults& results, const Groups& groups) {
  std::vector<std::string> metrics;
  for (const std::string& metric : results.metrics)
    if (std::any_of(groups.begin(), groups.end(),
                    [&](const SweepGroup* group) { return summarise(*group, metric).has_value(); }))
      metrics.push_back(metric);
  return metrics.empty() ? results.metrics : metrics;
}

std::string table_of(const SweepResults& results, const Groups& groups, bool with_dataset) {
  const std::vector<std::string> metrics = measured_of(results, groups);
  std::vector<std::pair<std::string, std::optional<double>>> best;
  // Values of different datasets are not compared.
  for (const std::string& metric : metrics)
    best.emplace_back(metric, with_dataset ? std::nullopt : best_of(groups, metric));
  Table table{.columns = header(results, with_dataset, metrics)};
  for (const SweepGroup* group : groups) table.add(body(results, with_dataset, *group, best));
  return table_markdown(table) + "\n";
}

/// The groups of each dataset, in the order of the plan.
std::vector<Groups> by_dataset(const SweepResults& results) {
  std::vector<Groups> parts;
  for (const SweepGroup& group : results.groups) {
    if (parts.empty() || parts.back().front()->point.dataset != group.point.dataset)
      parts.emplace_back();
    parts.back().push_back(&group);
  }
  return parts;
}

/// The groups of each module, in the order of their first occurrence.
std::vector<Groups> by_module(const Groups& groups) {
  std::vector<Groups> parts;
  for (const SweepGroup* group : groups) {
    const auto same = std::find_if(parts.begin(), parts.end(), [&](const Groups& part) {
      return part.front()->point.module == group->point.module;
    });
    (same == parts.end() ? parts.emplace_back() : *same).push_back(group);
  }
  return parts;
}

std::string tables_of(const SweepResults& results, const Groups& groups) {
  std::string text = "## " + groups.front()->point.dataset + "\n";
  const std::vector<Groups> modules = by_module(groups);
  for (const Groups& module : modules) {
    if (modules.size() > 1) text += "### " + module.front()->point.module + "\n";
    text += table_of(results, module, false);
  }
  return text;
}

std::string bound_of(const ExpectedMetric& expected) {
  if (expected.at_most && expected.at_least)
    return fmt::format("{} to {}", *expected.at_least, *expected.at_most);
  return expected.at_most ? fmt::format("≤ {}", *expected.at_most)
                          : fmt::format("≥ {}", *expected.at_least);
}

std::string expected_table(std::span<const ExpectationResult> expectations) {
  if (expectations.empty()) return "";
  const auto met = std::count_if(expectations.begin(), expectations.end(),
                                 [](const ExpectationResult& result) { return result.met; });
  Table table{.columns = {{"configuration"},
                          {"dataset"},
                          {"metric"},
                          {"expected", true},
                          {"measured", true},
                          {""}}};
  for (const ExpectationResult& result : expectations)
    table.add({result.expected->configuration, result.dataset,
               metric_info(result.expected->metric).label, bound_of(*result.expected),
               rounded(result.value), result.met ? "met" : "**missed**"});
  return fmt::format("## Expected metrics\n{} of {} met.\n\n", met, expectations.size()) +
         table_markdown(table) + "\n";
}

std::string method_text(const SweepResults& results) {
  std::string text;
  const std::string success = "; success is the share of runs with Wilson's 95 % interval. ";
  if (results.sweep.generate)
    text +=
        "Values are medians over the datasets of a scene, with the quartiles in brackets" + success;
  else if (has_seeds(results))
    text += "Errors are means over the seeds, with the minimum and maximum in brackets" + success;
  if (results.plan.runs.empty()) return text + "\n\n";
  text += results.sweep.repeat > 1
              ? fmt::format("Speeds are medians of {} repetitions", results.sweep.repeat)
              : "Speeds are those of a single repetition";
  text += results.sweep.timing ? ", one run at a time on one thread. "
                               : "; other runs may have used the machine at the same time. ";
  text += "The best value of each column is bold within a dataset.\n";
  std::set<std::string> machines, versions, aligned;
  for (const SweepRow& row : results.rows) {
    if (!row.machine.empty()) machines.insert(row.machine);
    if (!row.tool_version.empty()) versions.insert(row.tool_version);
    if (row.metrics.get("trajectory.aligned_freedoms"))
      aligned.insert(row.job->point.configuration);
  }
  if (!aligned.empty())
    text += fmt::format(
        "Errors of {} are after an alignment, since no pose was given at the start: by Sim(3) (7 "
        "aligned freedoms), or of position and heading (4) where an inertial sensor told metres "
        "and the vertical.\n",
        fmt::join(aligned, ", "));
  for (const std::string& machine : machines) text += "Machine: " + machine + ".\n";
  for (const std::string& version : versions) text += "saccade " + version + ".\n";
  return text + "\n";
}

}  // namespace

CsvTable sweep_csv(const SweepResults& results) {
  std::set<std::string> metrics;
  for (const SweepRow& row : results.rows)
    for (const auto& [key, value] : row.metrics.values()) metrics.insert(key);
  std::vector<std::string> columns{"job", "dataset", "dataset_seed"};
  const bool runs = !results.plan.runs.empty();
  if (runs) columns.insert(columns.end(), {"module", "configuration", "variant"});
  columns.insert(columns.end(), results.plan.axes.begin(), results.plan.axes.end());
  if (runs) columns.emplace_back("seed");
  columns.insert(columns.end(), {"status", "reason"});
  columns.insert(columns.end(), metrics.begin(), metrics.end());
  CsvTable csv(columns);
  for (const SweepRow& row : results.rows) {
    const SweepPoint& point = row.job->point;
    std::vector<CsvTable::Cell> cells{row.job->name, point.dataset, seed_cell(point.dataset_seed)};
    if (runs) cells.insert(cells.end(), {point.module, point.configuration, point.variant});
    for (const std::string& value : point.grid) cells.emplace_back(value);
    if (runs) cells.push_back(seed_cell(point.seed));
    cells.emplace_back(status_of(row));
    cells.emplace_back(reason_of(row));
    for (const std::string& key : metrics)
      cells.emplace_back(row.metrics.get(key).value_or(std::numeric_limits<double>::quiet_NaN()));
    csv.add(cells);
  }
  return csv;
}

std::string sweep_markdown(const SweepResults& results, std::span<const std::string> charts,
                           std::span<const ExpectationResult> expectations,
                           const std::vector<Table>& ablation) {
  const std::string title = results.sweep.title.empty() ? "Sweep" : results.sweep.title;
  std::string text = "# " + title + "\n\n" + method_text(results) + failures_section(results) +
                     stopped_section(results) + too_little_section(results);
  const auto parts = by_dataset(results);
  if (results.plan.runs.empty() || parts.size() == results.groups.size()) {
    // One row per dataset: a single table.
    std::vector<const SweepGroup*> all;
    for (const SweepGroup& group : results.groups) all.push_back(&group);
    text += table_of(results, all, true);
  } else {
    for (const Groups& groups : parts) text += tables_of(results, groups);
  }
  text += pooled_table(results) + sweep_leaderboards(results);
  text += ablation_section(ablation, results.sweep.reference) + expected_table(expectations);
  for (const std::string& chart : charts) text += chart + "\n\n";
  return text;
}

}  // namespace saccade
