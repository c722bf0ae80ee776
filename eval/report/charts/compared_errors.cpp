#include "eval/report/charts/compared_errors.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "eval/depth_views.h"
#include "eval/report/charts/timed_error.h"

namespace saccade {
namespace {

constexpr std::pair kPercent{0.0, 100.0};

/// The runs of one method, in the style that it has everywhere.
struct MethodRuns {
  ChartCurve style;
  std::vector<const RunData*> runs;  ///< at least one
};

std::vector<MethodRuns> by_method(std::span<const RunData* const> runs,
                                  const MethodStyles& styles) {
  std::vector<MethodRuns> methods;
  for (const RunData* run : runs) {
    auto known = std::find_if(methods.begin(), methods.end(), [&](const MethodRuns& method) {
      return method.style.name == run->method;
    });
    if (known == methods.end())
      known = methods.insert(methods.end(), {styles.curve(run->method), {}});
    known->runs.push_back(run);
  }
  return methods;
}

PageChart over_time(std::span<const MethodRuns> methods, const TimedError& error) {
  std::vector<std::pair<ChartCurve, const RunData*>> first;
  for (const MethodRuns& method : methods) first.emplace_back(method.style, method.runs.front());
  return chart_over_time(error, first.front().second->dataset, first);
}

/// Adds the distribution of the values of all runs of each method that has any.
void add_distributions(PageChart& chart, std::span<const MethodRuns> methods,
                       const std::function<std::vector<double>(const RunData&)>& values) {
  for (const MethodRuns& method : methods) {
    std::vector<double> pool;
    for (const RunData* run : method.runs) {
      const std::vector<double> own = values(*run);
      pool.insert(pool.end(), own.begin(), own.end());
    }
    ChartCurve curve = method.style;
    curve.points = cumulative_percent(std::move(pool));
    if (!curve.points.x.empty()) chart.curves.push_back(std::move(curve));
  }
}

PageChart distribution_over_time(std::span<const MethodRuns> methods, const TimedError& error) {
  const std::string& sequence = methods.front().runs.front()->dataset;
  PageChart chart{fmt::format("{}/{}/shares", sequence, error.id),
                  "Fraction of the time with at most this " + error.label,
                  fmt::format("{}: {}, cumulative", sequence, error.label),
                  {error.axis(), true},
                  {"fraction of the time [%]", false, kPercent},
                  {}};
  add_distributions(chart, methods, [&](const RunData& run) { return error.values_of(run); });
  return chart;
}

/// [%] of the truth, of all points of all views.
std::vector<double> relative_depth_errors(const RunData& run) {
  std::vector<double> values;
  if (!run.data || !run.metrics.get("depth.points")) return values;
  for (const DepthErrors& view : compare_views(load_depth_views(run.run.folder), *run.data))
    for (const DepthError& point : view.best) values.push_back(100 * point.relative);
  return values;
}

PageChart distribution_over_points(std::span<const MethodRuns> methods) {
  const std::string& sequence = methods.front().runs.front()->dataset;
  PageChart chart{sequence + "/depth/shares",
                  "Fraction of the points with at most this error of depth",
                  sequence + ": relative error of depth, cumulative",
                  {"relative error of depth [%]", true},
                  {"fraction of the points [%]", false, kPercent},
                  {}};
  add_distributions(chart, methods, relative_depth_errors);
  return chart;
}

}  // namespace

std::vector<PageChart> compared_errors(std::span<const RunData* const> runs,
                                       const MethodStyles& styles) {
  const std::vector<MethodRuns> methods = by_method(runs, styles);
  std::vector<PageChart> charts;
  if (methods.size() < 2) return charts;
  for (const TimedError& error : timed_errors(runs)) {
    charts.push_back(over_time(methods, error));
    charts.push_back(distribution_over_time(methods, error));
  }
  charts.push_back(distribution_over_points(methods));
  std::erase_if(charts, [](const PageChart& chart) { return chart.curves.size() < 2; });
  return charts;
}

}  // namespace saccade
