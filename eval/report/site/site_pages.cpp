#include "eval/report/site/site_pages.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <vector>

#include "core/io/files/sha256.h"
#include "eval/metrics/catalogue.h"
#include "eval/report/html.h"
#include "eval/report/page.h"
#include "eval/store/change_points.h"
#include "eval/table/number_text.h"
#include "eval/table/table.h"

namespace saccade {
namespace {

using Json = nlohmann::ordered_json;

/// The gate's (docs/gate.md): smaller changes of a level do not count.
constexpr double kSmallestChange = 0.03;

std::string day_of(const std::string& utc) { return utc.substr(0, utc.find('T')); }

std::string joined(const std::set<std::string>& names, std::size_t most = 3) {
  std::string text;
  std::size_t shown = 0;
  for (const std::string& name : names) {
    if (shown++ == most) return text + fmt::format(" and {} more", names.size() - most);
    text += (text.empty() ? "" : ", ") + name;
  }
  return text;
}

struct MethodSummary {
  std::string module;
  std::set<std::string> datasets;
  std::size_t reports = 0;
  const PublishedReport* latest = nullptr;
};

std::map<std::string, MethodSummary> methods_of(std::span<const PublishedReport> reports) {
  std::map<std::string, MethodSummary> methods;
  for (const PublishedReport& report : reports) {
    std::set<std::string> here;
    for (const PublishedRun& run : report.runs) {
      MethodSummary& method = methods[run.method];
      method.module = run.module;
      method.datasets.insert(run.dataset);
      method.latest = &report;
      if (here.insert(run.method).second) ++method.reports;
    }
  }
  return methods;
}

std::string report_address(const PublishedReport& report) {
  return "reports/" + report.name + "/index.html";
}

Table::Cell linked(const std::string& text, const std::string& address) {
  Table::Cell cell{text};
  cell.link = address;
  return cell;
}

Table::Cell count_cell(std::size_t count) {
  return number_cell(static_cast<double>(count), std::to_string(count));
}

Table report_list(std::span<const PublishedReport> reports) {
  Table table{"reports",
              fmt::format("Reports, the newest first ({})", reports.size()),
              {{"report"}, {"published"}, {"commit"}, {"methods"}, {"datasets"}}};
  table.add_numeric({"runs", "failed"});
  for (auto report = reports.rbegin(); report != reports.rend(); ++report) {
    std::set<std::string> commits, methods, datasets;
    std::size_t failed = 0;
    for (const PublishedRun& run : report->runs) {
      commits.insert(run.commit);
      methods.insert(run.method);
      datasets.insert(run.dataset);
      failed += run.problem.empty() ? 0 : 1;
    }
    table.rows.push_back({linked(report->title, report_address(*report)),
                          {day_of(report->published)},
                          {joined(commits)},
                          {joined(methods)},
                          {joined(datasets)},
                          count_cell(report->runs.size()),
                          count_cell(failed)});
  }
  return table;
}

Table method_list(std::span<const PublishedReport> reports) {
  const std::map<std::string, std::string> files = method_files(reports);
  Table table{"methods",
              fmt::format("Methods by name ({})", files.size()),
              {{"method"}, {"module"}, {"datasets"}, {"latest report"}}};
  table.add_numeric({"reports"});
  for (const auto& [name, method] : methods_of(reports))
    table.rows.push_back({linked(name, "methods/" + files.at(name)),
                          {method.module},
                          {joined(method.datasets)},
                          linked(method.latest->title, report_address(*method.latest)),
                          count_cell(method.reports)});
  return table;
}

/// The scores of a method on a dataset, by report and seed.
struct ScoreHistory {
  std::vector<const PublishedReport*> reports;
  std::vector<std::map<std::uint64_t, double>> by_seed;  ///< of each report

  void add(const PublishedReport& report, std::uint64_t seed, double value) {
    if (reports.empty() || reports.back() != &report) {
      reports.push_back(&report);
      by_seed.emplace_back();
    }
    by_seed.back()[seed] = value;
  }
  [[nodiscard]] double mean(std::size_t at) const {
    double sum = 0;
    for (const auto& [seed, value] : by_seed[at]) sum += value;
    return sum / static_cast<double>(by_seed[at].size());
  }
};

std::map<std::string, ScoreHistory> histories_of(const std::string& method,
                                                 const std::string& metric,
                                                 std::span<const PublishedReport> reports) {
  std::map<std::string, ScoreHistory> histories;
  for (const PublishedReport& report : reports)
    for (const PublishedRun& run : report.runs) {
      const auto score = run.scores.find(metric);
      if (run.method == method && score != run.scores.end())
        histories[run.dataset].add(report, run.seed, score->second);
    }
  return histories;
}

std::vector<ChangePoint> changes_of(const ScoreHistory& history) {
  std::set<std::uint64_t> seeds;
  for (const auto& values : history.by_seed)
    for (const auto& [seed, value] : values) seeds.insert(seed);
  CommitValues values;
  double size = 0;
  for (std::size_t i = 0; i < history.by_seed.size(); ++i) {
    values.emplace_back();
    for (const std::uint64_t seed : seeds) {
      const auto found = history.by_seed[i].find(seed);
      values.back().push_back(found == history.by_seed[i].end() ? std::nullopt
                                                                : std::optional(found->second));
    }
    size += std::abs(history.mean(i)) / static_cast<double>(history.by_seed.size());
  }
  return change_points(values, {.least_difference = kSmallestChange * size});
}

struct MethodMetric {
  MetricInfo info;
  std::map<std::string, ScoreHistory> histories;  ///< by dataset
};

std::vector<MethodMetric> metrics_of(const std::string& method,
                                     std::span<const PublishedReport> reports) {
  std::vector<MethodMetric> metrics;
  for (const MetricInfo& info : metric_catalogue()) {
    if (info.board.empty()) continue;
    auto histories = histories_of(method, info.key, reports);
    if (!histories.empty()) metrics.push_back({info, std::move(histories)});
  }
  return metrics;
}

std::string label_of(const MetricInfo& info) {
  const std::string unit = info.shown_unit();
  return unit.empty() ? info.board : info.board + " [" + unit + "]";
}

Table latest_scores(const std::vector<MethodMetric>& metrics) {
  Table table{"latest", "Latest scores, means over the seeds", {{"dataset"}}};
  std::set<std::string> datasets;
  for (const MethodMetric& metric : metrics) {
    table.columns.push_back({label_of(metric.info), true});
    for (const auto& [dataset, history] : metric.histories) datasets.insert(dataset);
  }
  for (const std::string& dataset : datasets) {
    std::vector<Table::Cell>& row = table.rows.emplace_back();
    row.push_back({dataset});
    for (const MethodMetric& metric : metrics) {
      const auto history = metric.histories.find(dataset);
      if (history == metric.histories.end()) {
        row.push_back({"–"});
        continue;
      }
      const std::size_t last = history->second.reports.size() - 1;
      const double value = metric.info.scale * history->second.mean(last);
      row.push_back(number_cell(value, significant(value)));
    }
  }
  return table;
}

PageChart trend_chart(const MethodMetric& metric, std::span<const PublishedReport> reports,
                      std::size_t index) {
  std::vector<std::string> datasets;
  for (const auto& [dataset, history] : metric.histories) datasets.push_back(dataset);
  const MethodStyles styles(datasets);
  PageChart chart{fmt::format("trend/{}", index),
                  label_of(metric.info),
                  metric.info.board + " over the reports",
                  {"report, in the order of publishing"},
                  {label_of(metric.info)},
                  {}};
  for (const auto& [dataset, history] : metric.histories) {
    ChartCurve curve = styles.curve(dataset);
    for (std::size_t i = 0; i < history.reports.size(); ++i)
      curve.points.add(1.0 + static_cast<double>(history.reports[i] - reports.data()),
                       five_digits(metric.info.scale * history.mean(i)));
    chart.curves.push_back(std::move(curve));
  }
  return chart;
}

Table change_list(const std::vector<MethodMetric>& metrics) {
  Table table{"changes",
              "Reports from which on a score has another level",
              {{"metric"}, {"dataset"}, {"report"}, {"published"}}};
  table.add_numeric({"before", "after", "p"});
  for (const MethodMetric& metric : metrics)
    for (const auto& [dataset, history] : metric.histories)
      for (const ChangePoint& change : changes_of(history)) {
        const PublishedReport& report = *history.reports[change.at];
        const double before = metric.info.scale * change.before;
        const double after = metric.info.scale * change.after;
        Table::Cell after_cell = number_cell(after, significant(after));
        if (metric.info.better != MetricInfo::Better::kNeither)
          after_cell.mark = (after > before) == metric.info.higher_is_better()
                                ? Table::Mark::kBetter
                                : Table::Mark::kWorse;
        table.rows.push_back({{label_of(metric.info)},
                              {dataset},
                              linked(report.title, "../" + report_address(report)),
                              {day_of(report.published)},
                              number_cell(before, significant(before)),
                              after_cell,
                              number_cell(change.p, significant(change.p, 2))});
      }
  return table;
}

/// Where the runs of the method are, the latest report first.
Table run_list(const std::string& method, std::span<const PublishedReport> reports) {
  Table table{"runs",
              "Those of the newest report first",
              {{"run"}, {"dataset"}, {"report"}, {"commit"}, {"outcome"}}};
  table.add_numeric({"seed"});
  for (auto report = reports.rbegin(); report != reports.rend(); ++report)
    for (const PublishedRun& run : report->runs)
      if (run.method == method)
        table.rows.push_back(
            {linked(run.name, "../reports/" + report->name + "/" + run.page),
             {run.dataset},
             linked(report->title, "../" + report_address(*report)),
             {run.commit},
             {run.problem.empty() ? "ok" : run.problem},
             number_cell(static_cast<double>(run.seed), std::to_string(run.seed))});
  return table;
}

std::string section(const char* id, const char* heading, const std::string& html) {
  return fmt::format("<section id=\"{}\"><h2>{}</h2>\n{}</section>\n", id, heading, html);
}

}  // namespace

std::map<std::string, std::string> method_files(std::span<const PublishedReport> reports) {
  constexpr std::size_t kHashDigits = 6;
  std::map<std::string, std::string> files;
  for (const auto& [method, summary] : methods_of(reports)) {
    std::string stem;
    bool is_plain = true;
    for (const char c : method) {
      const bool keeps = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
      stem += keeps ? c : '-';
      is_plain = is_plain && (keeps || c == ' ');
    }
    // Its address must not depend on what else there is: "a+b" and "a b" would be one page.
    if (!is_plain) stem += "-" + sha256(std::as_bytes(std::span(method))).substr(0, kHashDigits);
    files[method] = stem + ".html";
  }
  return files;
}

std::string site_index(std::span<const PublishedReport> reports) {
  const std::string search =
      "<p><label>Search <input type=\"search\" id=\"search\" data-runs=\"assets/runs.js\" "
      "placeholder=\"report, method, dataset or run\"></label></p>\n"
      "<ul id=\"found\" class=\"found\" aria-live=\"polite\"></ul>\n";
  return page_text({.title = "Reports",
                    .summary = "Runs scored against ground truth: reports, methods, and every run "
                               "with a page of its own.",
                    .contents = "<a href=\"#reports\">Reports</a><a href=\"#methods\">Methods</a>",
                    .body = search +
                            section("reports", "Reports", table_html(report_list(reports))) +
                            section("methods", "Methods", table_html(method_list(reports))),
                    .assets = "assets"});
}

std::string method_page(const std::string& method, std::span<const PublishedReport> reports) {
  const std::vector<MethodMetric> metrics = metrics_of(method, reports);
  std::vector<PageChart> trends, charts;
  for (std::size_t i = 0; i < metrics.size(); ++i)
    trends.push_back(trend_chart(metrics[i], reports, i));
  const Table changes = change_list(metrics);
  std::set<std::size_t> with_method;
  for (std::size_t i = 0; i < reports.size(); ++i)
    for (const PublishedRun& run : reports[i].runs)
      if (run.method == method) with_method.insert(i);
  // A course has two points at least.
  std::string trend_html = with_method.size() < 2
                               ? "<p class=\"note\">It stands in one report so far.</p>\n"
                               : chart_grid(trends, charts);
  trend_html += with_method.size() < 2 ? ""
                : changes.rows.empty()
                    ? "<p class=\"note\">No score has changed its level between reports.</p>\n"
                    : table_html(changes);
  return page_text(
      {.title = method,
       .summary = "Its latest scores, their course over the reports, and all its runs. "
                  "<a href=\"../index.html\">All reports</a>",
       .contents = "<a href=\"#latest\">Latest scores</a><a href=\"#trends\">Over the reports</a>"
                   "<a href=\"#runs\">Runs</a>",
       .body = section("latest", "Latest scores", table_html(latest_scores(metrics))) +
               section("trends", "Over the reports", trend_html) +
               section("runs", "Runs", table_html(run_list(method, reports))),
       .charts = charts,
       .assets = "../assets"});
}

std::string search_script(std::span<const PublishedReport> reports) {
  Json runs = Json::array();
  for (auto report = reports.rbegin(); report != reports.rend(); ++report)
    for (const PublishedRun& run : report->runs)
      runs.push_back(
          {fmt::format("{}, {} on {} ({})", run.name, run.method, run.dataset, report->title),
           "reports/" + report->name + "/" + run.page});
  return "globalThis.saccadeRuns = " + runs.dump(-1, ' ', false, Json::error_handler_t::replace) +
         ";\n";
}

}  // namespace saccade
