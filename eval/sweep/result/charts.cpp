#include "eval/sweep/result/charts.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

#include "core/config/convert.h"
#include "core/io/images/image_file.h"
#include "eval/metrics/catalogue.h"
#include "eval/picture/chart/bar_chart.h"
#include "eval/picture/chart/line_chart.h"

namespace saccade {
namespace {

/// More lines cannot be told apart; sweep.csv holds all of them.
constexpr std::size_t kMaxLines = 10;
constexpr std::size_t kMaxPanels = 4;

std::optional<double> number(const std::string& text) {
  return config::number_of(config::Node::scalar(text, false));
}

bool is_numeric(const GridAxis& axis) {
  return axis.values.size() > 1 &&
         std::all_of(axis.values.begin(), axis.values.end(),
                     [](const std::string& value) { return number(value).has_value(); });
}

std::vector<std::string> charted_metrics(const SweepResults& results) {
  std::vector<std::string> charted;
  for (const std::string& metric : results.metrics) {
    const bool wanted = !results.sweep.metrics.empty() || metric_info(metric).in_figures;
    const bool measured =
        std::any_of(results.groups.begin(), results.groups.end(),
                    [&](const SweepGroup& group) { return summarise(group, metric).has_value(); });
    if (wanted && measured && charted.size() < kMaxPanels) charted.push_back(metric);
  }
  return charted;
}

/// What distinguishes a group from the others of its dataset, without the axis `without`.
std::string label_of(const SweepResults& results, const SweepPoint& point,
                     std::optional<std::size_t> without) {
  std::string label;
  const auto add = [&](const std::string& text) { label += (label.empty() ? "" : ", ") + text; };
  if (results.sweep.configurations.size() > 1) add(point.configuration);
  if (!point.variant.empty()) add(point.variant);
  for (std::size_t i = 0; i < point.grid.size(); ++i)
    if (i != without && results.sweep.grid[i].values.size() > 1) {
      const std::string& key = results.plan.axes[i];
      add(key.substr(key.rfind('.') + 1) + " " + point.grid[i]);
    }
  return label;
}

std::string joined_label(const std::string& dataset, const std::string& rest) {
  return rest.empty() ? dataset : dataset + ", " + rest;
}

/// Index of `name` in `names`; a new name is appended.
std::size_t index_in(std::vector<std::string>& names, const std::string& name) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
  names.push_back(name);
  return names.size() - 1;
}

ChartValue chart_value(const MetricSummary& summary) {
  return {summary.value, summary.low, summary.high};
}

LineChart line_chart(const SweepResults& results, std::size_t axis) {
  LineChart chart;
  chart.x_label = results.plan.axes[axis];
  const std::vector<std::string> metrics = charted_metrics(results);
  std::vector<std::string> names;
  for (const SweepGroup& group : results.groups)
    index_in(names, joined_label(group.point.dataset, label_of(results, group.point, axis)));
  if (names.size() > kMaxLines) names.resize(kMaxLines);
  chart.names = names;
  for (const std::string& metric : metrics) {
    LineChart::Panel panel{metric_info(metric).label, {}};
    panel.lines.resize(names.size());
    for (const SweepGroup& group : results.groups) {
      const std::string name =
          joined_label(group.point.dataset, label_of(results, group.point, axis));
      const auto found = std::find(names.begin(), names.end(), name);
      const std::optional<MetricSummary> summary = summarise(group, metric);
      if (found == names.end() || !summary) continue;
      panel.lines[static_cast<std::size_t>(found - names.begin())].push_back(
          {*number(group.point.grid[axis]), chart_value(*summary)});
    }
    for (std::vector<LineChart::Point>& line : panel.lines)
      std::sort(line.begin(), line.end(),
                [](const LineChart::Point& a, const LineChart::Point& b) { return a.x < b.x; });
    chart.panels.push_back(std::move(panel));
  }
  return chart;
}

/// The rows are the labels or the datasets, whichever are more; the others are the bars of a row,
/// which differ in colour.
BarChart bar_chart(const SweepResults& results) {
  BarChart chart;
  std::vector<std::string> labels, datasets;
  for (const SweepGroup& group : results.groups) {
    index_in(labels, label_of(results, group.point, std::nullopt));
    index_in(datasets, group.point.dataset);
  }
  const bool by_dataset = datasets.size() > labels.size();
  chart.categories = by_dataset ? datasets : labels;
  chart.names = by_dataset ? labels : datasets;
  for (const std::string& metric : charted_metrics(results)) {
    BarChart::Panel panel{metric_info(metric).label, {}};
    panel.bars.assign(chart.categories.size(),
                      std::vector<std::optional<ChartValue>>(chart.names.size(), std::nullopt));
    for (const SweepGroup& group : results.groups)
      if (const std::optional<MetricSummary> summary = summarise(group, metric)) {
        const std::size_t label = index_in(labels, label_of(results, group.point, std::nullopt));
        const std::size_t dataset = index_in(datasets, group.point.dataset);
        panel.bars[by_dataset ? dataset : label][by_dataset ? label : dataset] =
            chart_value(*summary);
      }
    chart.panels.push_back(std::move(panel));
  }
  return chart;
}

std::string file_of(const std::string& axis) {
  std::string name = axis;
  std::replace_if(
      name.begin(), name.end(),
      [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '_'; }, '_');
  return "over_" + name;
}

bool varies(const SweepResults& results) {
  for (const SweepGroup& group : results.groups)
    if (group.point.dataset == results.groups.front().point.dataset &&
        &group != &results.groups.front())
      return true;
  return false;
}

/// Modules have different metrics, which one bar chart cannot compare.
bool has_several_modules(const SweepResults& results) {
  return std::any_of(results.groups.begin(), results.groups.end(), [&](const SweepGroup& group) {
    return group.point.module != results.groups.front().point.module;
  });
}

}  // namespace

std::vector<std::string> write_charts(const SweepResults& results,
                                      const std::filesystem::path& folder) {
  std::vector<std::string> images;
  if (!varies(results) || charted_metrics(results).empty()) return images;
  const auto write = [&](const auto& chart, const std::string& stem, const std::string& caption) {
    write_png(folder / (stem + ".png"), draw(chart, kLightTheme));
    save(chart, std::array{folder / (stem + ".pdf"), folder / (stem + ".svg")});
    images.push_back(
        fmt::format("![{0}]({1}.png) ([PDF]({1}.pdf), [SVG]({1}.svg))", caption, stem));
  };
  for (std::size_t axis = 0; axis < results.sweep.grid.size(); ++axis)
    if (is_numeric(results.sweep.grid[axis])) {
      const std::string& key = results.plan.axes[axis];
      write(line_chart(results, axis), file_of(key), "Over " + key);
    }
  if (images.empty() && !has_several_modules(results))
    write(bar_chart(results), "compared", "All rows compared");
  return images;
}

}  // namespace saccade
