#include "eval/report/charts/pareto.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>

#include "core/check.h"

namespace saccade {
namespace {

const LeaderboardRow* row_of(const Leaderboard& board, const std::string& method) {
  const auto found = std::find_if(board.rows.begin(), board.rows.end(),
                                  [&](const LeaderboardRow& row) { return row.method == method; });
  return found == board.rows.end() ? nullptr : &*found;
}

/// Geometric mean over the sequences; nullopt where one is missing, failed or not above 0.
std::optional<double> mean_over(const Leaderboard& board, const LeaderboardRow& row,
                                const std::vector<std::string>& sequences) {
  double sum = 0;
  for (const std::string& sequence : sequences) {
    const auto at = std::find(board.sequences.begin(), board.sequences.end(), sequence);
    if (at == board.sequences.end()) return std::nullopt;
    const LeaderboardScore& score =
        row.scores[static_cast<std::size_t>(at - board.sequences.begin())];
    if (!score.complete() || !(score.value->mean > 0)) return std::nullopt;
    sum += std::log(score.value->mean);
  }
  return std::exp(sum / static_cast<double>(sequences.size()));
}

}  // namespace

std::vector<SpeedAndScore> speeds_and_scores(const Leaderboard& board, const Leaderboard& speeds,
                                             const std::vector<std::string>& sequences) {
  SACCADE_CHECK(!sequences.empty());
  std::vector<SpeedAndScore> points;
  for (const LeaderboardRow& row : board.rows) {
    const LeaderboardRow* fast = row_of(speeds, row.method);
    if (fast == nullptr) continue;
    const std::optional<double> speed = mean_over(speeds, *fast, sequences);
    const std::optional<double> score = mean_over(board, row, sequences);
    if (speed && score) points.push_back({row.method, *speed, *score});
  }
  return points;
}

std::vector<SpeedAndScore> pareto_front(std::vector<SpeedAndScore> points, bool higher_is_better) {
  const auto worse = [&](const SpeedAndScore& point) {
    return higher_is_better ? -point.score : point.score;
  };
  std::stable_sort(points.begin(), points.end(),
                   [&](const SpeedAndScore& a, const SpeedAndScore& b) {
                     return std::tuple(-a.speed, worse(a)) < std::tuple(-b.speed, worse(b));
                   });
  std::vector<SpeedAndScore> front;
  for (const SpeedAndScore& point : points)
    if (front.empty() || worse(point) < worse(front.back())) front.push_back(point);
  std::reverse(front.begin(), front.end());
  return front;
}

}  // namespace saccade
