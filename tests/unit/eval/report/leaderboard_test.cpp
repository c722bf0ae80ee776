#include "eval/report/leaderboard.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace saccade {
namespace {

constexpr const char* kError = "trajectory.dt_rel_percent.mean";

LeaderboardEntry scored(const std::string& method, const std::string& sequence, double value,
                        const char* key = kError) {
  LeaderboardEntry entry{method, sequence, {}, "", ""};
  entry.metrics.set(key, value);
  return entry;
}

std::vector<std::string> methods_of(const Leaderboard& board) {
  std::vector<std::string> names;
  for (const LeaderboardRow& row : board.rows) names.push_back(row.method);
  return names;
}

TEST(Pooled, OneValueHasNoInterval) {
  const PooledValue value = pooled(std::vector{2.0});
  EXPECT_EQ(value.mean, 2);
  EXPECT_FALSE(value.low);
  EXPECT_EQ(value.count, 1U);
}

// Of 1, 2, 3: s = 1, and Student's t at 97.5 % with 2 degrees of freedom is 4.303.
TEST(Pooled, FewValuesByStudentsT) {
  const PooledValue value = pooled(std::vector{1.0, 2.0, 3.0});
  EXPECT_DOUBLE_EQ(value.mean, 2);
  EXPECT_NEAR(value.low.value(), 2 - 4.303 / std::sqrt(3.0), 1e-12);
  EXPECT_NEAR(value.high.value(), 2 + 4.303 / std::sqrt(3.0), 1e-12);
}

TEST(Pooled, ManyValuesByBootstrap) {
  const PooledValue value = pooled(std::vector{1.0, 1.1, 0.9, 1.2, 0.8, 1.05, 0.95, 1.0});
  EXPECT_NEAR(value.mean, 1, 1e-12);
  EXPECT_LT(value.low.value(), 1);
  EXPECT_GT(value.low.value(), 0.8);
  EXPECT_GT(value.high.value(), 1);
  EXPECT_LT(value.high.value(), 1.2);
}

TEST(Leaderboard, PoolsSeedsAndRanksByTheGeometricMean) {
  const std::vector<LeaderboardEntry> entries{scored("a", "walls", 1),  scored("a", "walls", 3),
                                              scored("a", "desk", 8),   scored("b", "walls", 1),
                                              scored("b", "desk", 1),   scored("b", "walls", 1),
                                              scored("c", "walls", 0.1)};
  const std::vector<Leaderboard> boards = leaderboards(entries);
  ASSERT_EQ(boards.size(), 1U);
  EXPECT_EQ(boards[0].sequences, (std::vector<std::string>{"walls", "desk"}));
  EXPECT_EQ(methods_of(boards[0]), (std::vector<std::string>{"b", "a", "c"}));
  const LeaderboardRow& a = boards[0].rows[1];
  EXPECT_EQ(a.rank, 2);
  EXPECT_EQ(a.scores[0].value->mean, 2);
  EXPECT_EQ(a.scores[0].value->count, 2U);
  EXPECT_NEAR(a.overall->mean, 4, 1e-12);
  EXPECT_FALSE(a.overall->low) << "two sequences say next to nothing of a third";
  EXPECT_EQ(boards[0].rows[2].rank, 0);
  EXPECT_EQ(boards[0].rows[2].complete, 1U);
}

TEST(Leaderboard, WhereHigherIsBetterTheHighestIsFirst) {
  const std::vector<LeaderboardEntry> entries{scored("a", "walls", 0.5, "reconstruction.ssim"),
                                              scored("b", "walls", 0.9, "reconstruction.ssim")};
  EXPECT_EQ(methods_of(leaderboards(entries).at(0)), (std::vector<std::string>{"b", "a"}));
}

TEST(Leaderboard, AScoreOfZeroHasNoGeometricMean) {
  const LeaderboardRow row = leaderboards(std::vector{scored("a", "walls", 0)}).at(0).rows.at(0);
  EXPECT_FALSE(row.overall);
  EXPECT_EQ(row.rank, 0);
}

TEST(Leaderboard, FailuresStandWithTheirReasonAndAreNotRanked) {
  std::vector<LeaderboardEntry> entries{scored("a", "walls", 1), scored("b", "walls", 0.5)};
  entries.push_back({"b", "walls", {}, "timed out: after 5 s", ""});
  entries.push_back({"c", "walls", {}, "crashed: signal 11", ""});
  const Leaderboard board = leaderboards(entries).at(0);
  EXPECT_EQ(methods_of(board), (std::vector<std::string>{"a", "b", "c"}));
  EXPECT_EQ(board.rows[0].rank, 1);
  EXPECT_EQ(board.rows[1].rank, 0);
  const Table table = leaderboard_table(board);
  EXPECT_EQ(table.rows[1][2].note, "1 of 2 failed");
  EXPECT_EQ(table.rows[2][2].text, "crashed: signal 11");
}

TEST(Leaderboard, TheTableHasTheBestOfEveryColumnInBold) {
  const std::vector<LeaderboardEntry> entries{scored("a", "walls", 1), scored("a", "desk", 2),
                                              scored("b", "walls", 2), scored("b", "desk", 3),
                                              scored("c", "desk", 1)};
  const Table table = leaderboard_table(leaderboards(entries).at(0));
  EXPECT_EQ(table.name, "leaderboard_trajectory_dt_rel_percent_mean");
  EXPECT_EQ(table.columns,
            (std::vector<Table::Column>{
                {"method"}, {"rank", true}, {"overall", true}, {"walls", true}, {"desk", true}}));
  EXPECT_TRUE(table.rows[0][2].best);
  EXPECT_TRUE(table.rows[0][3].best);
  EXPECT_FALSE(table.rows[0][4].best);
  EXPECT_TRUE(table.rows[2][4].best);
  EXPECT_EQ(table.rows[2][1].text, "1 of 2");
  EXPECT_FALSE(table.rows[2][2].best);
}

TEST(Leaderboard, ShowsFractionsInPercentAndMetresInMillimetres) {
  const Leaderboard depth =
      leaderboards(std::vector{scored("a", "walls", 0.02, "depth.rel_median")}).at(0);
  EXPECT_EQ(depth.label, "depth, median relative error [%]");
  EXPECT_EQ(depth.rows[0].scores[0].value->mean, 0.02) << "the score itself is unchanged";
  EXPECT_EQ(leaderboard_table(depth).rows[0][2].value->mean, 2);
  const Leaderboard path =
      leaderboards(std::vector{scored("a", "walls", 0.005, "trajectory.se3.ate_rmse_m"),
                               scored("a", "desk", 0.005, "trajectory.se3.ate_rmse_m")})
          .at(0);
  EXPECT_EQ(path.label, "ATE after SE(3), RMSE [mm]");
  EXPECT_NEAR(leaderboard_table(path).rows[0][2].value->mean, 5, 1e-12) << "overall";
  EXPECT_EQ(leaderboards(std::vector{scored("a", "walls", 1)}).at(0).label, "dt_rel, mean [%]");
}

// 6 is what a covariance promises, 3 is half and 60 ten times that.
TEST(Leaderboard, RanksNeesByTheFactorThatItIsOff) {
  constexpr const char* kKey = "trajectory.nees";
  const std::vector<LeaderboardEntry> entries{
      scored("sure", "walls", 60, kKey), scored("cautious", "walls", 3, kKey),
      scored("right", "walls", 6, kKey), scored("nothing", "walls", 0, kKey)};
  const std::vector<Leaderboard> boards = leaderboards(entries);
  ASSERT_EQ(boards.size(), 1U);
  EXPECT_EQ(methods_of(boards[0]), (std::vector<std::string>{"right", "cautious", "sure"}));
  EXPECT_DOUBLE_EQ(boards[0].rows[1].scores[0].value->mean, 2);
  EXPECT_EQ(boards[0].rows[1].scores[0].note, "NEES 3.00, too cautious");
  EXPECT_EQ(boards[0].rows[2].scores[0].note, "NEES 60.0, too sure");
}

}  // namespace
}  // namespace saccade
