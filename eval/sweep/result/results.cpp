#include "eval/sweep/result/results.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <tuple>

#include "core/config/suggest.h"
#include "core/io/dataset/dataset_record.h"
#include "core/io/files/atomic_file.h"
#include "core/median.h"
#include "core/process/parallel.h"
#include "core/process/progress.h"
#include "eval/evaluate.h"
#include "eval/metrics/catalogue.h"
#include "eval/metrics/statistics.h"
#include "eval/run_folder.h"
#include "eval/sweep/result/ablation.h"
#include "eval/sweep/result/charts.h"
#include "eval/sweep/result/dataset_information.h"
#include "eval/sweep/result/tables.h"

namespace saccade {
namespace {

constexpr const char* kSuccess = "success";

Metrics dataset_metrics(const std::filesystem::path& folder) {
  const DatasetRecord record = read_dataset_record(folder / "dataset.yaml");
  Metrics facts;
  if (record.counts)
    facts.set("dataset.events",
              static_cast<double>(record.counts->events_on + record.counts->events_off));
  facts.set("dataset.duration_s", record.duration_s);
  facts.set("dataset.mean_scene_depth_m", record.mean_scene_depth_m);
  facts.set("dataset.path_length_m", record.path_length_m);
  facts.set("dataset.rays_per_event", record.rays_per_event);
  facts.set("dataset.time_bound_us", record.time_bound_us);
  return facts;
}

void merge(Metrics& metrics, const Metrics& more, const std::string& prefix = "") {
  for (const auto& [key, value] : more.values()) metrics.set(prefix + key, value);
}

SweepRow read_row(const SweepJob& job) {
  SweepRow row{&job, false, {}, {}, {}};
  if (!job.scores.empty()) row.metrics = read_json_metrics(job.scores);
  if (!job.makes_run) {
    merge(row.metrics, dataset_metrics(job.output));
    return row;
  }
  // `eval` takes the timing of a run, but not that of an external simulator.
  if (job.point.module.empty())
    merge(row.metrics, read_json_metrics(job.output / "timing.json"), "speed.");
  const RunRecord record = read_run_record(job.output / "run.yaml");
  row.problem = record.problem();
  row.machine = record.machine;
  row.tool_version = record.tool_version;
  row.method_class = record.method_class;
  row.threads = record.threads;
  return row;
}

SweepRow failed_row(const SweepJob& job) {
  SweepRow row{&job, true, {}, {}, {}};
  row.problem = job.failure;
  return row;
}

bool any_has(const std::vector<SweepRow>& rows, const std::string& key) {
  return std::any_of(rows.begin(), rows.end(), [&](const SweepRow& row) {
    return speed_value(row.metrics, key).has_value();
  });
}

std::vector<std::string> known_keys(const std::vector<SweepRow>& rows) {
  std::set<std::string> keys;
  for (const SweepRow& row : rows)
    for (const auto& [key, value] : row.metrics.values()) keys.insert(key);
  return {keys.begin(), keys.end()};
}

/// A metric that no job has is reported, and the table is written all the same.
void warn_of_unknown(const SweepResults& results) {
  const std::vector<std::string> keys = known_keys(results.rows);
  for (const std::string& metric : results.metrics)
    if (!keys.empty() && !any_has(results.rows, metric))
      show_notice("metrics: no job has '" + metric + "'; " +
                  config::suggestion(metric, keys, "metrics"));
}

bool applies_to(const ExpectedMetric& expected, const SweepPoint& point) {
  const std::vector<std::string>& datasets = expected.datasets;
  return point.configuration == expected.configuration &&
         (datasets.empty() ||
          std::find(datasets.begin(), datasets.end(), point.dataset) != datasets.end());
}

ExpectationResult check(const ExpectedMetric& expected, const SweepGroup& group) {
  ExpectationResult result{&expected, group.point.dataset, std::nullopt, false};
  const std::optional<MetricSummary> summary = summarise(group, expected.metric);
  if (!summary) return result;
  result.value = summary->value;
  result.met = summary->count == group.rows.size() &&
               (!expected.at_most || summary->value <= *expected.at_most) &&
               (!expected.at_least || summary->value >= *expected.at_least);
  return result;
}

/// A run that was refused has no class of its own: it has that of its configuration's other runs.
void add_information(const DatasetInformation& information, std::vector<SweepRow>& rows) {
  using Compared = std::tuple<std::string, std::string, std::vector<std::string>>;
  const auto method_of = [](const SweepRow& row) {
    const SweepPoint& point = row.job->point;
    return Compared{point.configuration, point.variant, point.grid};
  };
  std::map<Compared, MethodClass> classes;
  for (const SweepRow& row : rows)
    if (row.method_class) classes.emplace(method_of(row), *row.method_class);
  for (SweepRow& row : rows) {
    if (const auto known = information.find(row.job->dataset); known != information.end())
      row.information = known->second;
    const auto method = classes.find(method_of(row));
    if (!row.method_class && method != classes.end()) row.method_class = method->second;
  }
}

SweepResults collect_results(const SweepConfig& sweep, const SweepPlan& plan) {
  SweepResults results{sweep, plan, {}, {}, sweep.metrics};
  std::vector<const SweepJob*> jobs;
  for (const SweepJob& job : plan.rows())
    if (job.state != JobState::kHeld) jobs.push_back(&job);
  results.rows.resize(jobs.size());
  parallel_for(jobs.size(), [&](std::size_t i) {
    const SweepJob& job = *jobs[i];
    results.rows[i] = job.state == JobState::kFailed ? failed_row(job) : read_row(job);
  });
  results.groups = group_by_seed(results.rows);
  if (sweep.metrics.empty())
    for (const MetricInfo& metric : default_metrics())
      if (any_has(results.rows, metric.key)) results.metrics.push_back(metric.key);
  return results;
}

}  // namespace

std::vector<SweepGroup> group_by_seed(const std::vector<SweepRow>& rows) {
  std::vector<SweepGroup> groups;
  // By what SweepPoint::differs_in_seed_only() compares: a sweep may have ten thousand points.
  using Key = std::tuple<std::string, std::string, std::string, std::vector<std::string>>;
  std::map<Key, std::size_t> known;
  for (const SweepRow& row : rows) {
    const SweepPoint& point = row.job->point;
    const auto [found, is_new] = known.emplace(
        Key{point.dataset, point.configuration, point.variant, point.grid}, groups.size());
    if (is_new) groups.push_back({point, {}});
    groups[found->second].rows.push_back(&row);
  }
  return groups;
}

std::optional<SuccessShare> success_of(std::span<const SweepRow* const> rows) {
  std::vector<RunOutcome> outcomes;
  for (const SweepRow* row : rows) outcomes.push_back(row->outcome());
  return success_share(outcomes);
}

std::optional<MetricSummary> summarise(const SweepGroup& group, const std::string& key) {
  if (key == kSuccess) {
    const std::optional<SuccessShare> share = success_of(group.rows);
    if (!share) return std::nullopt;
    return MetricSummary{share->value, share->low, share->high, share->count};
  }
  std::vector<double> values;
  for (const SweepRow* row : group.rows) {
    if (!row->problem.empty()) continue;  // the time until a crash is not a speed
    if (const std::optional<double> value = speed_value(row->metrics, key))
      values.push_back(*value);
  }
  if (values.empty()) return std::nullopt;
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  // Generated datasets differ by decades, so that a mean shows the worst of them alone.
  if (group.point.is_generated)
    return MetricSummary{median(values), values[(n - 1) / 4], values[n - 1 - (n - 1) / 4], n};
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(n);
  return MetricSummary{metric_info(key).is_speed ? median(values) : mean, values.front(),
                       values.back(), n};
}

std::vector<ExpectationResult> check_expectations(const SweepResults& results) {
  std::vector<ExpectationResult> found;
  for (const ExpectedMetric& expected : results.sweep.expected)
    for (const SweepGroup& group : results.groups)
      if (applies_to(expected, group.point)) found.push_back(check(expected, group));
  return found;
}

std::size_t write_sweep_results(const SweepConfig& sweep, const SweepPlan& plan,
                                const std::vector<StoppedRow>& stopped,
                                const std::filesystem::path& folder) {
  SweepResults results = collect_results(sweep, plan);
  results.stopped = stopped;
  if (sweep.generate) add_information(dataset_information(plan, folder), results.rows);
  warn_of_unknown(results);
  sweep_csv(results).save(folder / "sweep.csv");
  const std::vector<std::string> charts = write_charts(results, folder);
  const std::vector<ExpectationResult> expectations = check_expectations(results);
  const std::vector<Table> ablation = ablation_tables(results);
  if (!ablation.empty()) export_tables(ablation, folder);
  write_atomically(folder / "sweep.md", sweep_markdown(results, charts, expectations, ablation));
  return static_cast<std::size_t>(
      std::count_if(expectations.begin(), expectations.end(),
                    [](const ExpectationResult& expectation) { return !expectation.met; }));
}

}  // namespace saccade
