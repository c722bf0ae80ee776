#include "eval/report/sections/page_sections.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "eval/depth_views.h"
#include "eval/report/charts/pareto.h"
#include "eval/report/charts/timed_error.h"
#include "eval/report/html.h"

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
  PageChart chart{fmt::format("{}/{}/fractions", sequence, error.id),
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
  for (const DepthErrors& view : compare_views(load_depth_views(run.run, *run.data), *run.data))
    for (const DepthError& point : view.best) values.push_back(100 * point.relative);
  return values;
}

PageChart distribution_over_points(std::span<const MethodRuns> methods) {
  const std::string& sequence = methods.front().runs.front()->dataset;
  PageChart chart{sequence + "/depth/fractions",
                  "Fraction of the points with at most this error of depth",
                  sequence + ": relative error of depth, cumulative",
                  {"relative error of depth [%]", true},
                  {"fraction of the points [%]", false, kPercent},
                  {}};
  add_distributions(chart, methods, relative_depth_errors);
  return chart;
}

/// The errors of several methods on one sequence, in a chart for each: position and rotation over
/// time (of a method's first run) and the fraction of the time, or of the points with depth, that
/// is below an error (over all runs of a method). A chart that would show fewer than two methods is
/// left out.
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

constexpr const char* kSpeed = "speed.realtime_factor";

std::string scope_of(const Leaderboard& board, const std::string& sequence) {
  if (!sequence.empty()) return sequence;
  return board.sequences.size() == 1 ? board.sequences.front()
                                     : fmt::format("{} sequences", board.sequences.size());
}

ChartCurve front_curve(std::span<const SpeedAndScore> points, bool higher_is_better) {
  ChartCurve curve{"", "muted", true, ChartCurve::Kind::kFront};
  for (const SpeedAndScore& point : pareto_front({points.begin(), points.end()}, higher_is_better))
    curve.points.add(five_digits(point.speed), five_digits(point.score));
  return curve;
}

PageChart speed_chart(const Leaderboard& board, std::span<const SpeedAndScore> points,
                      const std::string& sequence, const MethodStyles& styles) {
  const std::string scope = scope_of(board, sequence);
  // A score of which more is better is a fraction or an index, an error may differ by decades.
  PageChart chart{fmt::format("{}/{}/speed", sequence, board.key),
                  fmt::format("{}, {}", board.label, scope),
                  fmt::format("{} against speed, {}", board.label, scope),
                  {"speed [× real time]", true},
                  {board.label, !board.higher_is_better},
                  {front_curve(points, board.higher_is_better)}};
  for (const SpeedAndScore& point : points) {
    ChartCurve curve = styles.curve(point.method);
    curve.kind = ChartCurve::Kind::kPoint;
    curve.points.add(five_digits(point.speed), five_digits(point.score));
    chart.curves.push_back(std::move(curve));
  }
  return chart;
}

/// Error against speed on a sequence, or with an empty name over all of a board's
/// (eval/report/charts/pareto.h), with the Pareto front: a chart for each board but the speed's on
/// which two methods or more have both. A board of a single sequence is drawn as the mean alone.
std::vector<PageChart> compared_speed(std::span<const Leaderboard> boards,
                                      const std::string& sequence, const MethodStyles& styles) {
  const auto speeds = std::find_if(boards.begin(), boards.end(),
                                   [](const Leaderboard& board) { return board.key == kSpeed; });
  std::vector<PageChart> charts;
  if (speeds == boards.end()) return charts;
  for (const Leaderboard& board : boards) {
    const bool drawn_as_mean = !sequence.empty() && board.sequences.size() == 1;
    if (&board == &*speeds || drawn_as_mean) continue;
    std::vector<SpeedAndScore> points = speeds_and_scores(
        board, *speeds, sequence.empty() ? board.sequences : std::vector{sequence});
    for (SpeedAndScore& point : points) point.score *= board.scale;  // as people are shown it
    if (points.size() > 1) charts.push_back(speed_chart(board, points, sequence, styles));
  }
  return charts;
}

/// Each once, in the order of the runs.
std::vector<std::string> names(std::span<const RunData> runs, std::string RunData::*name) {
  std::vector<std::string> result;
  for (const RunData& run : runs)
    if (std::find(result.begin(), result.end(), run.*name) == result.end())
      result.push_back(run.*name);
  return result;
}

/// Of the runs, then those that have published scores alone.
std::vector<std::string> all_methods(std::span<const RunData> runs,
                                     std::span<const Leaderboard> boards) {
  std::vector<std::string> methods = names(runs, &RunData::method);
  for (const Leaderboard& board : boards)
    for (const LeaderboardRow& row : board.rows)
      if (std::find(methods.begin(), methods.end(), row.method) == methods.end())
        methods.push_back(row.method);
  return methods;
}

std::string sequence_part(const std::string& sequence, std::span<const RunData> runs,
                          std::span<const Leaderboard> boards, const MethodStyles& styles,
                          std::vector<PageChart>& all) {
  std::vector<const RunData*> own;
  for (const RunData& run : runs)
    if (run.dataset == sequence) own.push_back(&run);
  std::string html = chart_grid(compared_errors(own, styles), all);
  const std::string speed = chart_grid(compared_speed(boards, sequence, styles), all);
  if (!speed.empty())
    html += fmt::format("<details><summary>Error against speed on {}</summary>\n{}</details>\n",
                        escape_html(sequence), speed);
  return html.empty() ? "" : fmt::format("<h3>{}</h3>\n{}", escape_html(sequence), html);
}

}  // namespace

std::string compared_section(std::span<const RunData> runs, std::span<const Leaderboard> boards,
                             std::vector<PageChart>& page) {
  const MethodStyles styles(all_methods(runs, boards));
  std::string html = chart_grid(compared_speed(boards, "", styles), page);
  if (!html.empty())
    html =
        "<p>Each method's score against its speed, as geometric means over the sequences of the "
        "table of the leaderboard, of methods that have all of them. The dashed steps are the "
        "Pareto front: no method is both faster and better than one on it.</p>\n" +
        html;
  std::string sequences;
  for (const std::string& sequence : names(runs, &RunData::dataset))
    sequences += sequence_part(sequence, runs, boards, styles, page);
  if (!sequences.empty())
    html +=
        "<p class=\"note\">Below, errors over time are those of a method's first run; "
        "distributions "
        "are of all its runs, whatever their seed.</p>\n" +
        sequences;
  if (html.empty()) return "";
  return "<section id=\"compared\"><h2>Compared</h2>\n" + html + "</section>\n";
}

}  // namespace saccade
