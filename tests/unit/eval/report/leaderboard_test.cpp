#include "eval/report/leaderboard.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace saccade {
namespace {

constexpr const char* kError = "trajectory.dt_rel_percent.mean";

LeaderboardEntry scored(const std::string& method, const std::string& sequence, double value,
                        const char* key = kError) {
  LeaderboardEntry entry{.method = method, .sequence = sequence};
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
  EXPECT_EQ(boards[0].rows[2].sequences, 1U);
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

const MethodClass kTracking{{MethodInput::kEvents, MethodInput::kMap}, Processing::kCausal};
const MethodClass kOdometry{{MethodInput::kEvents, MethodInput::kStart}, Processing::kFixedLag};

LeaderboardEntry of_class(LeaderboardEntry entry, const MethodClass& method_class) {
  entry.method_class = method_class;
  return entry;
}

/// A run whose error and loss are known.
LeaderboardEntry judged(const std::string& method, const std::string& sequence, double value,
                        double ate_m, double lost_s = 0) {
  LeaderboardEntry entry = scored(method, sequence, value);
  const bool succeeded = ate_m < 0.01 && lost_s == 0;
  entry.metrics.set("success", succeeded ? 1 : 0);
  entry.metrics.set("trajectory.none.ate_rmse_m", ate_m);
  entry.metrics.set("trajectory.mean_depth_m", 1);
  entry.metrics.set("trajectory.lost_s", lost_s);
  if (lost_s > 0) entry.metrics.set("trajectory.loss.first_s", 0.425);
  return entry;
}

LeaderboardEntry failed(const std::string& method, const std::string& sequence,
                        const std::string& problem) {
  return {.method = method, .sequence = sequence, .problem = problem};
}

/// The text of the cell in the column of this title.
const Table::Cell& cell(const Table& table, std::size_t row, const std::string& title) {
  const auto found =
      std::find_if(table.columns.begin(), table.columns.end(),
                   [&](const Table::Column& column) { return column.title == title; });
  EXPECT_NE(found, table.columns.end()) << title;
  return table.rows.at(row).at(static_cast<std::size_t>(found - table.columns.begin()));
}

TEST(Leaderboard, AFailureStandsWithItsReasonBehindThoseThatSucceeded) {
  const std::vector<LeaderboardEntry> entries{scored("a", "walls", 1), scored("b", "walls", 0.5),
                                              failed("b", "walls", "timed out: after 5 s"),
                                              failed("c", "walls", "refused: no parallax")};
  const Leaderboard board = leaderboards(entries).at(0);
  EXPECT_EQ(methods_of(board), (std::vector<std::string>{"a", "b", "c"}));
  EXPECT_EQ(board.rows[0].rank, 1);
  EXPECT_EQ(board.rows[1].rank, 2) << "its mean is smaller, but of half of its runs alone";
  EXPECT_EQ(board.rows[2].rank, 0) << "without any score";
  const Table table = leaderboard_table(board);
  EXPECT_EQ(cell(table, 1, "walls").text, "0.500 (1 of 2 runs)");
  EXPECT_EQ(cell(table, 1, "walls").note, "timed out: after 5 s");
  EXPECT_EQ(cell(table, 1, "runs").text, "2 (1 failed)");
  EXPECT_EQ(cell(table, 2, "walls").text, "refused");
  EXPECT_EQ(cell(table, 2, "walls").note, "refused: no parallax");
}

// Were the lost run part of the mean, it would be 13.5; were it left out unnoticed, "lost" would win.
TEST(Leaderboard, AMeanIsOverSuccessesBesideTheirShare) {
  const std::vector<LeaderboardEntry> entries{
      judged("lost", "walls", 0.2, 0.002),      judged("lost", "desk", 40, 0.5, 1.5),
      judged("lost", "office", 0.2, 0.002),     judged("inaccurate", "walls", 0.3, 0.003),
      judged("inaccurate", "desk", 0.3, 0.003), judged("inaccurate", "office", 1.6, 0.016),
      judged("good", "walls", 0.8, 0.008),      judged("good", "desk", 0.8, 0.008),
      judged("good", "office", 0.8, 0.008)};
  const Leaderboard board = leaderboards(entries).at(0);
  EXPECT_EQ(methods_of(board), (std::vector<std::string>{"good", "lost", "inaccurate"}));
  const LeaderboardRow& lost = board.rows[1];
  EXPECT_EQ(lost.rank, 2);
  EXPECT_NEAR(lost.overall->mean, 0.2, 1e-12);
  EXPECT_EQ(lost.failed, 1U);
  ASSERT_TRUE(lost.success);
  EXPECT_NEAR(lost.success->value, 2.0 / 3, 1e-12);
  EXPECT_EQ(lost.success->count, 3U);
  // Wilson's interval of 2 of 3.
  EXPECT_NEAR(lost.success->low, 0.2077, 1e-4);
  EXPECT_NEAR(lost.success->high, 0.9385, 1e-4);
  const Table table = leaderboard_table(board);
  EXPECT_EQ(cell(table, 1, "desk").text, "lost after 0.425 s");
  EXPECT_EQ(cell(table, 2, "office").text, "ATE of 1.60 % of the depth");
  EXPECT_NEAR(cell(table, 1, "success [%]").value->mean, 200.0 / 3, 1e-9);
  EXPECT_EQ(cell(table, 1, "overall").note, "over successes");
}

TEST(Leaderboard, ARunWithoutAPoseIsAFailureAndNotAbsent) {
  LeaderboardEntry silent{.method = "silent", .sequence = "walls"};
  silent.metrics.set("trajectory.poses", 0);
  silent.metrics.set("success", 0);
  const Leaderboard board = leaderboards(std::vector{judged("a", "walls", 1, 0), silent}).at(0);
  EXPECT_EQ(methods_of(board), (std::vector<std::string>{"a", "silent"}));
  EXPECT_EQ(board.rows[1].success->value, 0);
  EXPECT_EQ(cell(leaderboard_table(board), 1, "walls").text, "no pose");
}

// It is aligned before it is scored, so that its errors say as much as those of any run.
TEST(Leaderboard, ARunInAWorldOfItsOwnStandsOnEveryBoardThatItHasAScoreOf) {
  LeaderboardEntry own = judged("own start", "walls", 0.4, 0.004);
  own.metrics.set("trajectory.aligned_freedoms", 7);
  own.metrics.set("trajectory.se3.ate_rmse_m", std::nullopt);
  LeaderboardEntry given = judged("given start", "walls", 0.5, 0.005);
  given.metrics.set("trajectory.se3.ate_rmse_m", 0.002);
  const std::vector<Leaderboard> boards = leaderboards(std::vector{own, given});
  ASSERT_EQ(boards.size(), 2U);
  EXPECT_EQ(methods_of(boards[0]), (std::vector<std::string>{"own start", "given start"}));
  EXPECT_EQ(boards[1].key, "trajectory.se3.ate_rmse_m");
  EXPECT_EQ(methods_of(boards[1]), std::vector<std::string>{"given start"});
}

TEST(Leaderboard, RanksWithinAClassAlone) {
  std::vector<LeaderboardEntry> entries{of_class(scored("given a map", "walls", 0.1), kTracking),
                                        of_class(scored("no map", "walls", 0.4), kOdometry),
                                        of_class(scored("no map, better", "walls", 0.3), kOdometry),
                                        scored("who knows", "walls", 0.01)};
  MethodClass batch = kOdometry;
  batch.processing = Processing::kBatch;
  entries.push_back(of_class(scored("looks ahead", "walls", 0.2), batch));
  const Leaderboard board = leaderboards(entries).at(0);
  EXPECT_EQ(methods_of(board), (std::vector<std::string>{"no map, better", "no map", "looks ahead",
                                                         "given a map", "who knows"}));
  std::vector<int> ranks;
  for (const LeaderboardRow& row : board.rows) ranks.push_back(row.rank);
  EXPECT_EQ(ranks, (std::vector<int>{1, 2, 1, 1, 1}));
  const Table table = leaderboard_table(board);
  EXPECT_EQ(cell(table, 0, "inputs").text, "events + given start");
  EXPECT_EQ(cell(table, 0, "processing").text, "fixed lag");
  EXPECT_EQ(cell(table, 2, "processing").text, "batch");
  EXPECT_EQ(cell(table, 3, "inputs").text, "events + map");
  EXPECT_EQ(cell(table, 4, "inputs").text, "unknown");
  EXPECT_TRUE(cell(table, 0, "walls").best);
  EXPECT_FALSE(cell(table, 3, "walls").best) << "nothing to compare it with";
}

TEST(Leaderboard, AFailedRunBelongsToTheClassOfItsMethod) {
  const std::vector<LeaderboardEntry> entries{
      failed("a", "desk", "refused: nothing moves"), of_class(scored("a", "walls", 1), kTracking),
      of_class(scored("b", "walls", 2), kTracking), of_class(scored("b", "desk", 2), kTracking)};
  const Leaderboard board = leaderboards(entries).at(0);
  ASSERT_EQ(methods_of(board), (std::vector<std::string>{"b", "a"}));
  EXPECT_EQ(board.rows[1].method_class, kTracking);
  EXPECT_EQ(board.rows[1].rank, 2);
}

TEST(Leaderboard, AFailureThatStatesItsClassIsOfThatClassInAnyOrder) {
  const LeaderboardEntry refused = failed("a", "desk", "refused: nothing moves");
  const LeaderboardEntry crashed = of_class(failed("a", "office", "crashed"), kOdometry);
  const LeaderboardEntry scored_b = scored("b", "walls", 2);
  for (const auto& entries :
       {std::vector{refused, crashed, scored_b}, std::vector{crashed, refused, scored_b}}) {
    const Leaderboard board = leaderboards(entries).at(0);
    const auto a = std::find_if(board.rows.begin(), board.rows.end(),
                                [](const LeaderboardRow& row) { return row.method == "a"; });
    ASSERT_NE(a, board.rows.end());
    EXPECT_EQ(a->method_class, kOdometry);
    EXPECT_EQ(a->failed, 2U);
  }
  // A crash by one's own statement is none of the method's other class.
  const Leaderboard board =
      leaderboards(std::vector{of_class(scored("a", "walls", 1), kTracking), crashed}).at(0);
  ASSERT_EQ(board.rows.size(), 2U);
  EXPECT_EQ(board.rows[0].failed + board.rows[1].failed, 1U);
  for (const LeaderboardRow& row : board.rows)
    EXPECT_EQ(row.failed, row.method_class == kOdometry ? 1U : 0U);
}

// A method that is for some sequences alone is not measured by those of another class.
TEST(Leaderboard, RankedAreMethodsWithAllSequencesOfTheirClass) {
  const std::vector<LeaderboardEntry> entries{
      of_class(scored("a", "walls", 1), kTracking), of_class(scored("a", "desk", 1), kTracking),
      of_class(scored("b", "walls", 2), kTracking), of_class(scored("c", "walls", 3), kOdometry)};
  const Leaderboard board = leaderboards(entries).at(0);
  ASSERT_EQ(methods_of(board), (std::vector<std::string>{"c", "a", "b"}));
  EXPECT_EQ(board.rows[0].rank, 1);
  EXPECT_EQ(board.rows[1].rank, 1);
  EXPECT_EQ(board.rows[2].rank, 0);
  EXPECT_EQ(cell(leaderboard_table(board), 2, "rank").text, "1 of 2");
}

TEST(Leaderboard, AFailureStandsOnTheBoardsOfItsModule) {
  LeaderboardEntry depth = scored("depth", "walls", 0.01, "depth.rel_median");
  depth.module = "depth";
  LeaderboardEntry refused = failed("depth", "desk", "refused: no poses");
  refused.module = "depth";
  LeaderboardEntry track = scored("track", "walls", 1);
  track.module = "track";
  const std::vector<Leaderboard> boards = leaderboards(std::vector{depth, refused, track});
  ASSERT_EQ(boards.size(), 2U);
  EXPECT_EQ(methods_of(boards[0]), std::vector<std::string>{"track"});
  EXPECT_EQ(boards[1].key, "depth.rel_median");
  EXPECT_EQ(cell(leaderboard_table(boards[1]), 0, "desk").text, "refused");
}

TEST(Leaderboard, TheIntervalOverWorldsIsTheBootstrapOfTheirLogarithms) {
  std::vector<LeaderboardEntry> entries;
  std::vector<double> logs;
  for (int i = 0; i < 20; ++i) {
    const double error = std::exp(0.1 * (i % 7) - 1);
    logs.push_back(std::log(error));
    entries.push_back(scored("a", "world-" + std::to_string(i), error));
  }
  const Leaderboard board = leaderboards(entries).at(0);
  const PooledValue mean = pooled(logs);
  EXPECT_DOUBLE_EQ(board.rows[0].overall->low.value(), std::exp(*mean.low));
  EXPECT_DOUBLE_EQ(board.rows[0].overall->high.value(), std::exp(*mean.high));
  for (const Table::Column& column : leaderboard_table(board).columns)
    EXPECT_FALSE(column.title.starts_with("world-")) << "too many columns";
}

TEST(Leaderboard, StatesThreadsAndSpeed) {
  std::vector<LeaderboardEntry> entries{scored("a", "walls", 1), scored("a", "desk", 1)};
  for (std::size_t i = 0; i < 2; ++i) {
    entries[i].threads = static_cast<int>(i) + 1;
    entries[i].metrics.set("speed.realtime_factor.median", i == 0 ? 2 : 8);
  }
  const Table table = leaderboard_table(leaderboards(entries).at(0));
  EXPECT_EQ(cell(table, 0, "threads").text, "1, 2");
  EXPECT_FALSE(cell(table, 0, "threads").value);
  const Table single = leaderboard_table(leaderboards(std::span(entries).first(1)).at(0));
  EXPECT_EQ(cell(single, 0, "threads").value->mean, 1) << "a number that sorts";
  EXPECT_NEAR(cell(table, 0, "× real time").value->mean, 4, 1e-12);
}

TEST(Leaderboard, TheTableHasTheBestOfEveryColumnInBold) {
  const std::vector<LeaderboardEntry> entries{scored("a", "walls", 1), scored("a", "desk", 2),
                                              scored("b", "walls", 2), scored("b", "desk", 3),
                                              scored("c", "desk", 1)};
  const Table table = leaderboard_table(leaderboards(entries).at(0));
  EXPECT_EQ(table.name, "leaderboard_trajectory_dt_rel_percent_mean");
  EXPECT_TRUE(cell(table, 0, "overall").best);
  EXPECT_TRUE(cell(table, 0, "walls").best);
  EXPECT_FALSE(cell(table, 0, "desk").best);
  EXPECT_TRUE(cell(table, 2, "desk").best);
  EXPECT_EQ(cell(table, 2, "rank").text, "1 of 2");
  EXPECT_FALSE(cell(table, 2, "overall").best);
}

TEST(Leaderboard, ShowsFractionsInPercentAndMetresInMillimetres) {
  const Leaderboard depth =
      leaderboards(std::vector{scored("a", "walls", 0.02, "depth.rel_median")}).at(0);
  EXPECT_EQ(depth.label, "depth, median relative error [%]");
  EXPECT_EQ(depth.rows[0].scores[0].value->mean, 0.02) << "the score itself is unchanged";
  EXPECT_EQ(cell(leaderboard_table(depth), 0, "walls").value->mean, 2);
  const Leaderboard path =
      leaderboards(std::vector{scored("a", "walls", 0.005, "trajectory.se3.ate_rmse_m"),
                               scored("a", "desk", 0.005, "trajectory.se3.ate_rmse_m")})
          .at(0);
  EXPECT_EQ(path.label, "ATE after SE(3), RMSE [mm]");
  EXPECT_NEAR(cell(leaderboard_table(path), 0, "overall").value->mean, 5, 1e-12);
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
