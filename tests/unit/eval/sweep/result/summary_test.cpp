#include <gtest/gtest.h>

#include "eval/sweep/result/results.h"

namespace saccade {
namespace {

std::optional<MetricSummary> summary_of(const std::vector<double>& values, bool is_generated) {
  const std::string key = "trajectory.dt_rel_percent.mean";
  SweepJob job;
  std::vector<SweepRow> rows;
  for (const double value : values) {
    rows.push_back({&job, false, {}, {}, {}});
    rows.back().metrics.set(key, value);
  }
  SweepGroup group;
  group.point.is_generated = is_generated;
  for (const SweepRow& row : rows) group.rows.push_back(&row);
  return summarise(group, key);
}

TEST(Summary, OverSeedsIsTheMeanWithItsRange) {
  const auto summary = summary_of({1, 2, 9}, false);
  EXPECT_DOUBLE_EQ(summary->value, 4);
  EXPECT_DOUBLE_EQ(summary->low, 1);
  EXPECT_DOUBLE_EQ(summary->high, 9);
}

TEST(Summary, OverGeneratedDatasetsIsTheMedianWithItsQuartiles) {
  const auto summary = summary_of({5, 1, 2, 1000, 3, 4, 6, 7, 8}, true);
  EXPECT_DOUBLE_EQ(summary->value, 5);
  EXPECT_DOUBLE_EQ(summary->low, 3);
  EXPECT_DOUBLE_EQ(summary->high, 7);
  EXPECT_EQ(summary->count, 9U);
}

}  // namespace
}  // namespace saccade
