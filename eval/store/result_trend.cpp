#include "eval/store/result_trend.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "core/config/suggest.h"
#include "core/error.h"
#include "core/io/tables/csv_file.h"
#include "eval/gate/comparison.h"
#include "eval/metrics/catalogue.h"
#include "eval/table/number_text.h"
#include "eval/table/table.h"

namespace saccade {
namespace {

using Json = nlohmann::ordered_json;

std::string commit_of(const ResultRow& row) {
  return row.commit.empty() ? row.version : row.commit;
}

std::string sequence_of(const ResultRow& row, bool with_machine) {
  std::string text = row.dataset + ", " + row.module + " " + row.config;
  if (row.start_s && row.end_s) text += fmt::format(", {:.2f}-{:.2f} s", *row.start_s, *row.end_s);
  if (with_machine) text += fmt::format(", {}, {} threads", row.machine, row.threads);
  return text;
}

/// Sum and number of the runs of one commit and seed.
struct SeedValue {
  double sum = 0;
  std::size_t runs = 0;
};

struct CommitRuns {
  std::string added;
  std::map<std::uint64_t, SeedValue> seeds;
};

Trend trend_of(const std::string& sequence, const std::map<std::string, CommitRuns>& commits,
               const MetricInfo& metric) {
  Trend trend{sequence, {}, {}};
  std::vector<std::pair<std::string, const CommitRuns*>> order;
  std::set<std::uint64_t> seeds;
  for (const auto& [commit, runs] : commits) {
    order.emplace_back(commit, &runs);
    for (const auto& seed : runs.seeds) seeds.insert(seed.first);
  }
  std::sort(order.begin(), order.end(), [](const auto& a, const auto& b) {
    return std::pair(a.second->added, a.first) < std::pair(b.second->added, b.first);
  });
  CommitValues values;
  double largest = 0;
  for (const auto& [commit, runs] : order) {
    TrendPoint point{commit, runs->added, 0, 0};
    values.emplace_back();
    for (const std::uint64_t seed : seeds) {
      const auto found = runs->seeds.find(seed);
      values.back().emplace_back();
      if (found == runs->seeds.end()) continue;
      const double mean = found->second.sum / static_cast<double>(found->second.runs);
      values.back().back() = mean;
      point.runs += found->second.runs;
      point.mean += found->second.sum;
    }
    point.mean /= static_cast<double>(point.runs);
    largest = std::max(largest, std::abs(point.mean));
    trend.points.push_back(point);
  }
  trend.changes = change_points(
      values, {.least_difference = largest * metric.tolerance.value_or(GateOptions().tolerance)});
  return trend;
}

std::string change_text(const ChangePoint& change, const MetricInfo& metric) {
  const double difference = change.after - change.before;
  const bool worse = (difference > 0) != metric.higher_is_better();
  const char* verdict = metric.better == MetricInfo::Better::kNeither ? "changed"
                        : worse                                       ? "worse"
                                                                      : "better";
  return change.before == 0 ? fmt::format("{} (p {:.2g})", verdict, change.p)
                            : fmt::format("{}: {:+.1f} % (p {:.2g})", verdict,
                                          100 * difference / std::abs(change.before), change.p);
}

const ChangePoint* change_at(const Trend& trend, std::size_t point) {
  const auto found = std::find_if(trend.changes.begin(), trend.changes.end(),
                                  [&](const ChangePoint& change) { return change.at == point; });
  return found == trend.changes.end() ? nullptr : &*found;
}

Json trend_json(const ResultTrend& trend) {
  Json trends = Json::array();
  for (const Trend& one : trend.trends) {
    Json points = Json::array(), changes = Json::array();
    for (const TrendPoint& point : one.points)
      points.push_back({{"commit", point.commit},
                        {"added", point.added},
                        {"runs", point.runs},
                        {"mean", point.mean}});
    for (const ChangePoint& change : one.changes)
      changes.push_back({{"commit", one.points[change.at].commit},
                         {"before", change.before},
                         {"after", change.after},
                         {"p", change.p}});
    trends.push_back({{"sequence", one.sequence}, {"points", points}, {"changes", changes}});
  }
  return {{"metric", trend.metric}, {"trends", trends}};
}

std::string trend_csv(const ResultTrend& trend) {
  CsvTable csv({"sequence", "commit", "added", "runs", "mean", "change_p"});
  for (const Trend& one : trend.trends)
    for (std::size_t i = 0; i < one.points.size(); ++i) {
      const TrendPoint& point = one.points[i];
      const ChangePoint* change = change_at(one, i);
      csv.add({one.sequence, point.commit, point.added, static_cast<double>(point.runs), point.mean,
               change ? change->p : std::numeric_limits<double>::quiet_NaN()});
    }
  return csv.text();
}

std::string trend_table(const ResultTrend& trend) {
  const MetricInfo metric = metric_info(trend.metric);
  std::string text;
  for (const Trend& one : trend.trends) {
    Table table{.columns = {{"commit"}, {"added"}, {"runs", true}, {trend.metric, true}, {""}}};
    for (std::size_t i = 0; i < one.points.size(); ++i) {
      const TrendPoint& point = one.points[i];
      const ChangePoint* change = change_at(one, i);
      table.add({point.commit, point.added.substr(0, 10), std::to_string(point.runs),
                 significant(point.mean, 4), change ? change_text(*change, metric) : ""});
    }
    text += one.sequence + "\n" + table_text(table) + "\n";
  }
  return text;
}

}  // namespace

ResultTrend result_trend(ResultReader& reader, const std::string& metric, std::string_view where) {
  const std::string stored = reader.stored_metric(metric);
  if (stored.empty())
    throw InputError("--trend", "no stored run has '" + metric + "'; " +
                                    config::suggestion(metric, reader.metric_names(), "metrics"));
  const MetricInfo info = metric_info(stored);
  const std::vector<ResultRow> rows = reader.select(where);
  const MetricTable table = reader.metrics(rows, {stored});
  std::map<std::string, std::map<std::string, CommitRuns>> sequences;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double value = table.at(i, 0);
    if (std::isnan(value)) continue;
    CommitRuns& runs = sequences[sequence_of(rows[i], info.is_speed)][commit_of(rows[i])];
    if (runs.added.empty() || rows[i].added < runs.added) runs.added = rows[i].added;
    SeedValue& seed = runs.seeds[rows[i].seed];
    seed.sum += value;
    ++seed.runs;
  }
  ResultTrend trend{stored, {}};
  for (const auto& [sequence, commits] : sequences)
    trend.trends.push_back(trend_of(sequence, commits, info));
  return trend;
}

std::string format_trend(const ResultTrend& trend, ResultFormat format) {
  if (format == ResultFormat::kJson) return trend_json(trend).dump(2) + "\n";
  return format == ResultFormat::kCsv ? trend_csv(trend) : trend_table(trend);
}

std::vector<FlakyMetric> flaky_metrics(ResultReader& reader, std::string_view where) {
  const std::vector<ResultRow> rows = reader.select(where);
  const MetricTable table = reader.metrics(rows, reader.metric_names());
  std::map<std::pair<std::string, std::string>, std::vector<std::size_t>> groups;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const ResultRow& row = rows[i];
    const std::string work = fmt::format("{}|{}|{}|{}|{}", commit_of(row), row.seed, row.machine,
                                         row.dataset_sha256, row.config_sha256);
    groups[{sequence_of(row, false), work}].push_back(i);
  }
  std::erase_if(groups, [](const auto& group) { return group.second.size() < 2; });
  if (groups.empty())
    throw InputError(
        "--flaky",
        "no two stored runs did the same work (commit, dataset, configuration, window, "
        "seed, machine); repeat runs into other folders");
  std::map<std::pair<std::string, std::string>, FlakyMetric> found;
  for (const auto& [key, runs] : groups)
    for (std::size_t metric = 0; metric < table.names().size(); ++metric) {
      const std::string& name = table.names()[metric];
      if (name.starts_with("speed.")) continue;
      double low = std::numeric_limits<double>::infinity(), high = -low, sum = 0;
      std::size_t count = 0;
      for (const std::size_t run : runs)
        if (const double value = table.at(run, metric); !std::isnan(value)) {
          low = std::min(low, value);
          high = std::max(high, value);
          sum += value;
          ++count;
        }
      if (count == 0) continue;
      FlakyMetric& flaky = found[{key.first, name}];
      flaky.sequence = key.first;
      flaky.metric = name;
      ++flaky.groups;
      // A metric that some of the runs lack differs, too.
      const bool differs = count < runs.size() || high > low;
      if (!differs) continue;
      ++flaky.flaky;
      const double mean = std::abs(sum / static_cast<double>(count));
      if (mean > 0) flaky.spread = std::max(flaky.spread, (high - low) / mean);
    }
  std::vector<FlakyMetric> flaky;
  for (const auto& [key, metric] : found)
    if (metric.flaky > 0) flaky.push_back(metric);
  std::stable_sort(flaky.begin(), flaky.end(),
                   [](const FlakyMetric& a, const FlakyMetric& b) { return a.spread > b.spread; });
  return flaky;
}

std::string format_flaky(const std::vector<FlakyMetric>& metrics, ResultFormat format) {
  if (format == ResultFormat::kJson) {
    Json list = Json::array();
    for (const FlakyMetric& metric : metrics)
      list.push_back({{"sequence", metric.sequence},
                      {"metric", metric.metric},
                      {"groups", metric.groups},
                      {"flaky", metric.flaky},
                      {"spread", metric.spread}});
    return list.dump(2) + "\n";
  }
  if (format == ResultFormat::kCsv) {
    CsvTable csv({"sequence", "metric", "groups", "flaky", "spread"});
    for (const FlakyMetric& metric : metrics)
      csv.add({metric.sequence, metric.metric, static_cast<double>(metric.groups),
               static_cast<double>(metric.flaky), metric.spread});
    return csv.text();
  }
  if (metrics.empty()) return "runs that did the same work have the same scores\n";
  Table table{.columns = {{"sequence"}, {"metric"}, {"differs", true}, {"spread", true}}};
  for (const FlakyMetric& metric : metrics)
    table.add({metric.sequence, metric.metric, fmt::format("{} of {}", metric.flaky, metric.groups),
               fmt::format("{} %", significant(100 * metric.spread))});
  return table_text(table);
}

}  // namespace saccade
