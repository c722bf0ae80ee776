#include "eval/store/result_trend.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <cmath>

#include "core/random.h"
#include "tests/support/error_of.h"
#include "tests/unit/eval/store/stored_runs.h"

namespace saccade {
namespace {

using testing::error_of;
using ::testing::HasSubstr;
using testing::kDrift;

/// `seeds` values of each of `commits` about 1 with a scatter of 3 %; `step` more from `at` on. Each
/// seed has a level of its own.
CommitValues values_with_step(std::size_t commits, std::size_t seeds, std::size_t at, double step,
                              std::uint64_t trial) {
  const Random random(trial);
  CommitValues values;
  for (std::size_t commit = 0; commit < commits; ++commit) {
    values.emplace_back();
    for (std::size_t seed = 0; seed < seeds; ++seed)
      values.back().emplace_back(1 + 0.2 * static_cast<double>(seed) +
                                 0.03 * random.normal(commit, seed) + (commit >= at ? step : 0));
  }
  return values;
}

TEST(ChangePoints, FindsAStepAtItsCommit) {
  int found = 0;
  for (std::uint64_t trial = 0; trial < 50; ++trial) {
    const auto changes = change_points(values_with_step(12, 3, 7, 0.1, trial));
    found += changes.size() == 1 && changes.front().at == 7;
  }
  EXPECT_GE(found, 45);
}

TEST(ChangePoints, RaisesFewFalseAlarms) {
  int alarms = 0;
  for (std::uint64_t trial = 0; trial < 200; ++trial)
    alarms += !change_points(values_with_step(12, 3, 0, 0, trial)).empty();
  // Binomial with 200 trials of 1 %: 8 and more have a probability below 0.1 %.
  EXPECT_LT(alarms, 8);
}

TEST(ChangePoints, FindsTwoStepsAndTheirLevels) {
  CommitValues values;
  for (const double level : {1.0, 1.0, 1.0, 2.0, 2.0, 2.0, 2.0, 1.5, 1.5, 1.5})
    values.push_back({level, level + 1, level + 2, std::nullopt});
  const auto changes = change_points(values);
  ASSERT_EQ(changes.size(), 2U);
  EXPECT_EQ(changes[0].at, 3U);
  EXPECT_EQ(changes[1].at, 7U);
  EXPECT_DOUBLE_EQ(changes[0].before, 2);
  EXPECT_DOUBLE_EQ(changes[0].after, 3);
  EXPECT_DOUBLE_EQ(changes[1].after, 2.5);
}

TEST(ChangePoints, NothingChangesWhereNothingDiffers) {
  EXPECT_TRUE(change_points({}).empty());
  EXPECT_TRUE(change_points({{1.0}, {1.0}, {1.0}}).empty());
  const auto tiny = change_points(values_with_step(12, 3, 7, 0.1, 1), {.least_difference = 0.5});
  EXPECT_TRUE(tiny.empty());
}

class StoredTrend : public ::testing::Test {
 protected:
  void add(const testing::StoredRun& run) {
    store_result(testing::write_stored_run(folder_.path(), run));
  }
  ResultReader reader() { return ResultReader(folder_.path() / kResultStoreName); }

  testing::TemporaryFolder folder_;
};

TEST_F(StoredTrend, GroupsByCommitAndNamesTheNearestMetric) {
  for (int commit = 0; commit < 8; ++commit)
    for (std::uint64_t seed = 1; seed < 4; ++seed)
      add({.name = fmt::format("run_{}_{}", commit, seed),
           .commit = fmt::format("{0}{0}{0}{0}{0}{0}{0}{0}{0}{0}{0}{0}", commit),
           .seed = seed,
           .metrics = testing::one_metric(
               kDrift, (commit < 5 ? 1 : 1.2) + 0.001 * static_cast<double>(seed))});
  ResultReader from = reader();
  const ResultTrend trend = result_trend(from, kDrift);
  ASSERT_EQ(trend.trends.size(), 1U);
  ASSERT_EQ(trend.trends[0].points.size(), 8U);
  EXPECT_EQ(trend.trends[0].points[0].runs, 3U);
  ASSERT_EQ(trend.trends[0].changes.size(), 1U);
  EXPECT_EQ(trend.trends[0].changes[0].at, 5U);
  EXPECT_THAT(format_trend(trend, ResultFormat::kTable), HasSubstr("worse: +20.0 %"));
  EXPECT_THAT(format_trend(trend, ResultFormat::kJson), HasSubstr("\"commit\": \"555555555555\""));
  EXPECT_THAT(error_of([&] { return result_trend(from, "trajectory.drift_prcent"); }),
              HasSubstr("trajectory.drift_percent"));
}

TEST_F(StoredTrend, FlakyIsWhatDiffersBetweenEqualRuns) {
  add({.name = "a", .metrics = testing::one_metric(kDrift, 1)});
  add({.name = "other_seed", .seed = 2, .metrics = testing::one_metric(kDrift, 3)});
  ResultReader before = reader();
  EXPECT_THAT(error_of([&] { return flaky_metrics(before); }), HasSubstr("--flaky"));
  add({.name = "b", .metrics = testing::one_metric(kDrift, 1)});
  ResultReader equal = reader();
  EXPECT_TRUE(flaky_metrics(equal).empty());
  add({.name = "c", .metrics = testing::one_metric(kDrift, 1.1)});
  ResultReader from = reader();
  const std::vector<FlakyMetric> flaky = flaky_metrics(from);
  ASSERT_EQ(flaky.size(), 1U);
  EXPECT_EQ(flaky[0].metric, kDrift);
  EXPECT_NEAR(flaky[0].spread, 0.1 / (3.1 / 3), 1e-12);
  EXPECT_THAT(format_flaky(flaky, ResultFormat::kTable), HasSubstr("1 of 1"));
}

}  // namespace
}  // namespace saccade
