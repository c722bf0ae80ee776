#include "eval/report/charts/compared_speed.h"

#include <fmt/format.h>

#include <algorithm>

#include "eval/report/charts/pareto.h"

namespace saccade {
namespace {

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

}  // namespace

std::vector<PageChart> compared_speed(std::span<const Leaderboard> boards,
                                      const std::string& sequence, const MethodStyles& styles) {
  const auto speeds = std::find_if(boards.begin(), boards.end(),
                                   [](const Leaderboard& board) { return board.key == kSpeed; });
  std::vector<PageChart> charts;
  if (speeds == boards.end()) return charts;
  for (const Leaderboard& board : boards) {
    const bool drawn_as_mean = !sequence.empty() && board.sequences.size() == 1;
    if (&board == &*speeds || drawn_as_mean) continue;
    const std::vector<SpeedAndScore> points = speeds_and_scores(
        board, *speeds, sequence.empty() ? board.sequences : std::vector{sequence});
    if (points.size() > 1) charts.push_back(speed_chart(board, points, sequence, styles));
  }
  return charts;
}

}  // namespace saccade
