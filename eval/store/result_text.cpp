#include "eval/store/result_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "core/config/suggest.h"
#include "core/error.h"
#include "core/io/tables/csv_file.h"
#include "eval/metrics/catalogue.h"
#include "eval/table/number_text.h"
#include "eval/table/table.h"

namespace saccade {
namespace {

constexpr std::string_view kConfigText = "config_yaml";

constexpr std::array<std::string_view, 6> kTableColumns{"run",    "dataset", "module",
                                                        "config", "seed",    "commit"};

const ResultColumn* find_column(std::string_view name) {
  for (const ResultColumn& column : result_columns())
    if (column.name == name) return &column;
  return nullptr;
}

[[noreturn]] void fail_unknown(const ResultReader& reader, const std::string& name) {
  std::vector<std::string> all;
  for (const ResultColumn& column : result_columns()) all.push_back(column.name);
  const std::vector<std::string> metrics = reader.metric_names();
  all.insert(all.end(), metrics.begin(), metrics.end());
  throw InputError("--columns", "'" + name + "' is no column and no metric of a stored run; " +
                                    config::suggestion(name, all, "names"));
}

ResultSelection named_columns(const ResultReader& reader, const std::vector<std::string>& names) {
  ResultSelection selection;
  for (const std::string& name : names) {
    if (const ResultColumn* column = find_column(name)) {
      selection.columns.push_back(*column);
      continue;
    }
    const std::string metric = reader.stored_metric(name);
    if (metric.empty()) fail_unknown(reader, name);
    selection.metrics.push_back(metric);
  }
  return selection;
}

/// For a table: what is longer than a terminal bears is cut.
std::string cell_text(const CsvTable::Cell& cell) {
  constexpr std::size_t kLongest = 48;
  if (const auto* text = std::get_if<std::string>(&cell))
    return text->size() <= kLongest ? *text : text->substr(0, kLongest - 3) + "...";
  if (const auto* whole = std::get_if<long long>(&cell)) return std::to_string(*whole);
  const double value = std::get<double>(cell);
  return std::isnan(value) ? fixed(std::nullopt, 0) : fmt::format("{}", value);
}

/// "poses/s" of speed.poses_per_s.median; else the key.
std::string metric_label(const std::string& key) {
  constexpr std::string_view kMedian = ".median";
  const std::string plain =
      key.ends_with(kMedian) ? key.substr(0, key.size() - kMedian.size()) : key;
  const std::string label = metric_info(plain).label;
  return label == plain ? key : label;
}

std::optional<double> measured(double value) {
  return std::isnan(value) ? std::nullopt : std::optional(value);
}

std::string results_table(std::span<const ResultRow> rows, const MetricTable& metrics,
                          std::span<const ResultColumn> columns) {
  Table table;
  std::vector<std::size_t> shown;
  for (const ResultColumn& column : columns) table.columns.push_back({column.name});
  for (std::size_t i = 0; i < metrics.names().size(); ++i) {
    if (!metrics.any_has(i)) continue;
    shown.push_back(i);
    table.columns.push_back({metric_label(metrics.names()[i]), true});
  }
  for (std::size_t row = 0; row < rows.size(); ++row) {
    std::vector<std::string> cells;
    for (const ResultColumn& column : columns) cells.push_back(cell_text(column.of(rows[row])));
    for (const std::size_t i : shown) cells.push_back(rounded(measured(metrics.at(row, i))));
    table.add(cells);
  }
  return table_text(table) + fmt::format("{} {}\n", rows.size(), rows.size() == 1 ? "run" : "runs");
}

std::string results_csv(std::span<const ResultRow> rows, const MetricTable& metrics,
                        std::span<const ResultColumn> columns) {
  std::vector<std::string> titles;
  for (const ResultColumn& column : columns) titles.push_back(column.name);
  titles.insert(titles.end(), metrics.names().begin(), metrics.names().end());
  CsvTable table(titles);
  std::vector<CsvTable::Cell> cells;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    cells.clear();
    for (const ResultColumn& column : columns) cells.push_back(column.of(rows[row]));
    for (std::size_t i = 0; i < metrics.names().size(); ++i) cells.emplace_back(metrics.at(row, i));
    table.add(cells);
  }
  return table.text();
}

std::string json_text(const std::string& text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string json_number(double value) {
  return std::isnan(value) ? "null" : fmt::format("{}", value);
}

std::string json_member(const ResultRow& row, const ResultColumn& column) {
  const auto json = [&](auto pointer) -> std::string {
    const auto& value = row.*pointer;
    using Value = std::decay_t<decltype(value)>;
    if constexpr (std::is_same_v<Value, std::optional<double>>)
      return json_number(value.value_or(std::numeric_limits<double>::quiet_NaN()));
    else if constexpr (std::is_same_v<Value, std::string>)
      return json_text(value);
    else
      return std::to_string(value);
  };
  return std::visit(json, column.member);
}

/// Written piece by piece: a tree of ten thousand runs would take longer than reading them.
std::string results_json(std::span<const ResultRow> rows, const MetricTable& metrics,
                         std::span<const ResultColumn> columns) {
  std::vector<std::string> keys;
  for (const std::string& name : metrics.names()) keys.push_back(json_text(name));
  std::string text = "[";
  for (std::size_t row = 0; row < rows.size(); ++row) {
    text += row == 0 ? "\n{" : ",\n{";
    for (const ResultColumn& column : columns)
      text += "\"" + column.name + "\": " + json_member(rows[row], column) + ", ";
    text += "\"metrics\": {";
    for (std::size_t i = 0; i < keys.size(); ++i)
      text += (i == 0 ? "" : ", ") + keys[i] + ": " + json_number(metrics.at(row, i));
    text += "}}";
  }
  return text + "\n]\n";
}

std::string signed_percent(double percent) {
  return std::isnan(percent) ? fixed(std::nullopt, 2) : fmt::format("{:+.2f} %", percent);
}

std::string diff_table(const ResultDiff& diff) {
  Table table{.columns = {{"metric"},
                          {"pairs", true},
                          {diff.a, true},
                          {diff.b, true},
                          {"change", true},
                          {"better", true},
                          {"worse", true}}};
  for (const ChangeSummary& change : summarise_changes(diff))
    table.add({change.metric, std::to_string(change.pairs), rounded(change.a), rounded(change.b),
               signed_percent(change.median_percent), std::to_string(change.better),
               std::to_string(change.worse)});
  std::string text = table_text(table);
  text += fmt::format("{} {} by {}; values: means, change: median over the pairs\n",
                      diff.pairs.size(), diff.pairs.size() == 1 ? "pair" : "pairs", diff.by);
  if (!diff.alone.empty())
    text += fmt::format("without a partner: {}\n", config::joined(diff.alone));
  return text;
}

bool nowhere_measured(const MetricChange& change) {
  return std::isnan(change.a) && std::isnan(change.b);
}

std::string diff_csv(const ResultDiff& diff) {
  CsvTable table(
      {"dataset", "module", "config", "window", "seed", "metric", "a", "b", "change_percent"});
  for (const ResultPair& pair : diff.pairs)
    for (std::size_t i = 0; i < diff.metrics.size(); ++i) {
      const MetricChange& change = pair.changes[i];
      if (nowhere_measured(change)) continue;
      table.add({pair.key.dataset, pair.key.module, pair.key.config, pair.key.window,
                 std::to_string(pair.key.seed), diff.metrics[i], change.a, change.b,
                 change.percent()});
    }
  return table.text();
}

std::string diff_json(const ResultDiff& diff) {
  std::string text = fmt::format("{{\"a\": {}, \"b\": {}, \"by\": {}, \"pairs\": [",
                                 json_text(diff.a), json_text(diff.b), json_text(diff.by));
  for (const ResultPair& pair : diff.pairs) {
    text += fmt::format(
        "{}\n{{\"dataset\": {}, \"module\": {}, \"config\": {}, \"window\": {}, "
        "\"seed\": {}, \"metrics\": {{",
        &pair == diff.pairs.data() ? "" : ",", json_text(pair.key.dataset),
        json_text(pair.key.module), json_text(pair.key.config), json_text(pair.key.window),
        pair.key.seed);
    const char* comma = "";
    for (std::size_t i = 0; i < diff.metrics.size(); ++i) {
      const MetricChange& change = pair.changes[i];
      if (nowhere_measured(change)) continue;
      text += fmt::format("{}{}: {{\"a\": {}, \"b\": {}, \"change_percent\": {}}}", comma,
                          json_text(diff.metrics[i]), json_number(change.a), json_number(change.b),
                          json_number(change.percent()));
      comma = ", ";
    }
    text += "}}";
  }
  text += "\n], \"alone\": [";
  for (const std::string& run : diff.alone)
    text += (&run == diff.alone.data() ? "" : ", ") + json_text(run);
  return text + "]}\n";
}

}  // namespace

ResultSelection select_columns(const ResultReader& reader, const std::vector<std::string>& names,
                               ResultFormat format) {
  if (!names.empty()) return named_columns(reader, names);
  ResultSelection selection;
  if (format == ResultFormat::kTable) {
    for (const std::string_view name : kTableColumns)
      selection.columns.push_back(*find_column(name));
    for (const MetricInfo& metric : default_metrics())
      if (std::string stored = reader.stored_metric(metric.key); !stored.empty())
        selection.metrics.push_back(std::move(stored));
    return selection;
  }
  for (const ResultColumn& column : result_columns())
    if (column.name != kConfigText) selection.columns.push_back(column);
  selection.metrics = reader.metric_names();
  return selection;
}

std::string format_results(std::span<const ResultRow> rows, const MetricTable& metrics,
                           std::span<const ResultColumn> columns, ResultFormat format) {
  switch (format) {
    case ResultFormat::kCsv:
      return results_csv(rows, metrics, columns);
    case ResultFormat::kJson:
      return results_json(rows, metrics, columns);
    case ResultFormat::kTable:
      break;
  }
  return results_table(rows, metrics, columns);
}

std::string list_results(ResultReader& reader, std::string_view where,
                         const std::vector<std::string>& columns, ResultFormat format) {
  ResultSelection selection = select_columns(reader, columns, format);
  const bool with_config_text =
      std::any_of(selection.columns.begin(), selection.columns.end(),
                  [](const ResultColumn& column) { return column.name == kConfigText; });
  const std::vector<ResultRow> rows = reader.select(where, with_config_text);
  const MetricTable metrics = reader.metrics(rows, std::move(selection.metrics));
  return format_results(rows, metrics, selection.columns, format);
}

std::string format_diff(const ResultDiff& diff, ResultFormat format) {
  switch (format) {
    case ResultFormat::kCsv:
      return diff_csv(diff);
    case ResultFormat::kJson:
      return diff_json(diff);
    case ResultFormat::kTable:
      break;
  }
  return diff_table(diff);
}

}  // namespace saccade
