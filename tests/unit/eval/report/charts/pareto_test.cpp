#include "eval/report/charts/pareto.h"

#include <gtest/gtest.h>

namespace saccade {
namespace {

constexpr const char* kPositionError = "trajectory.dt_rel_percent.mean";

std::vector<std::string> methods_of(const std::vector<SpeedAndScore>& points) {
  std::vector<std::string> methods;
  for (const SpeedAndScore& point : points) methods.push_back(point.method);
  return methods;
}

TEST(Pareto, KeepsWhatNoOtherBeatsFromSlowToFast) {
  const std::vector<SpeedAndScore> points{
      {"fast", 10, 3}, {"beaten", 4, 5}, {"slow", 1, 1}, {"as fast, worse", 10, 4}, {"mid", 5, 2}};
  EXPECT_EQ(methods_of(pareto_front(points, false)),
            (std::vector<std::string>{"slow", "mid", "fast"}));
  EXPECT_EQ(methods_of(pareto_front(points, true)),
            (std::vector<std::string>{"beaten", "as fast, worse"}));
  EXPECT_TRUE(pareto_front({}, true).empty());
}

LeaderboardEntry timed(const std::string& method, const std::string& sequence, double error,
                       double speed) {
  LeaderboardEntry entry{.method = method, .sequence = sequence};
  entry.metrics.set(kPositionError, error);
  entry.metrics.set("speed.realtime_factor", speed);
  return entry;
}

TEST(Pareto, TakesBothAsGeometricMeansOverTheSequences) {
  std::vector<LeaderboardEntry> entries{timed("a", "walls", 1, 2), timed("a", "desk", 4, 8),
                                        timed("b", "walls", 1, 1)};
  LeaderboardEntry untimed = timed("c", "walls", 3, 1);
  untimed.metrics = {};
  untimed.metrics.set(kPositionError, 3.0);
  entries.push_back(untimed);
  const std::vector<Leaderboard> boards = leaderboards(entries);
  ASSERT_EQ(boards.size(), 2U);
  const auto all = speeds_and_scores(boards[0], boards[1], boards[0].sequences);
  ASSERT_EQ(methods_of(all), std::vector<std::string>{"a"});
  EXPECT_DOUBLE_EQ(all[0].score, 2);
  EXPECT_DOUBLE_EQ(all[0].speed, 4);
  EXPECT_EQ(speeds_and_scores(boards[0], boards[1], {"walls"}).size(), 2U);
}

TEST(Pareto, AFailedRunKeepsItsMethodOut) {
  const LeaderboardEntry failed{.method = "a", .sequence = "walls", .problem = "crashed"};
  const std::vector<LeaderboardEntry> entries{timed("a", "walls", 1, 2), timed("b", "walls", 1, 1),
                                              failed};
  const std::vector<Leaderboard> boards = leaderboards(entries);
  EXPECT_EQ(methods_of(speeds_and_scores(boards[0], boards[1], {"walls"})),
            std::vector<std::string>{"b"});
}

}  // namespace
}  // namespace saccade
