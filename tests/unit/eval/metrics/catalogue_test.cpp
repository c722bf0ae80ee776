#include "eval/metrics/catalogue.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include <fmt/format.h>

#include "eval/gate/gate_metric.h"
#include "eval/table/table.h"
#include "tests/support/command.h"
#include "tests/support/source_path.h"

namespace saccade {
namespace {

using Better = MetricInfo::Better;

TEST(Catalogue, HoldsEveryKeyOnce) {
  std::set<std::string> keys;
  for (const MetricInfo& metric : metric_catalogue()) {
    EXPECT_TRUE(keys.insert(metric.key).second) << metric.key;
    EXPECT_FALSE(metric.needs.empty()) << metric.key;
    EXPECT_GT(metric.floor.value_or(1), 0) << metric.key;
  }
}

TEST(Catalogue, TheGateJudgesWhatHasABetterSide) {
  ASSERT_GT(gate_metrics().size(), 10U);
  for (const MetricInfo& metric : gate_metrics()) {
    EXPECT_NE(metric.better, Better::kNeither) << metric.key;
    EXPECT_EQ(metric.key.find('*'), std::string::npos) << metric.key;
  }
}

TEST(MetricInfo, FillsInTheFamilies) {
  EXPECT_EQ(metric_info("trajectory.dt_rel_percent.max").better, Better::kLower);
  EXPECT_EQ(metric_info("trajectory.rpe.length_10_percent.trans_percent").unit, "%");
  EXPECT_EQ(metric_info("trajectory.rpe.per_second.trans_rmse_m").better, Better::kLower);
  EXPECT_EQ(metric_info("trajectory.rpe.per_second.pairs").better, Better::kNeither);
  EXPECT_EQ(metric_info("depth.strict.rel_mean").scale, 100);
  EXPECT_EQ(metric_info("depth.views.points.worst").better, Better::kNeither);
  EXPECT_EQ(metric_info("reconstruction.worst.ssim").better, Better::kHigher);
  EXPECT_EQ(metric_info("speed.events_per_s.median").better, Better::kHigher);
  EXPECT_EQ(metric_info("speed.stages_s.points").better, Better::kLower);
  EXPECT_TRUE(metric_info("speed.wall_s.median").is_speed);
  EXPECT_EQ(metric_info("speed.wall_s.median").label, "speed.wall_s.median");
}

TEST(MetricInfo, KnowsWhatHasARow) {
  EXPECT_TRUE(is_catalogued("trajectory.poses"));
  EXPECT_TRUE(is_catalogued("trajectory.rpe.per_second.pairs"));
  EXPECT_FALSE(is_catalogued("trajectory.new_error_m"));
}

TEST(MetricInfo, AMetricOfSomebodyElseIsAnError) {
  const MetricInfo metric = metric_info("mine.error");
  EXPECT_EQ(metric.label, "mine.error");
  EXPECT_EQ(metric.better, Better::kLower);
  EXPECT_FALSE(metric.floor);
}

// More events near their true position are better; a key with "within" once was taken for an error.
TEST(MetricInfo, MoreEventsWithinAPixelAreBetter) {
  EXPECT_LT(*worsening(metric_info("stabilization.within_1px"), 0.5, 0.6), 0);
}

TEST(MetricInfo, ShowsFractionsInPercentAndMetresInMillimetres) {
  EXPECT_EQ(metric_info("trajectory.coverage").shown_unit(), "%");
  EXPECT_EQ(metric_info("trajectory.se3.ate_rmse_m").shown_unit(), "mm");
  EXPECT_EQ(metric_info("trajectory.dtheta_deg.mean").shown_unit(), "deg");
  Metrics metrics;
  metrics.set("trajectory.coverage", 0.25);
  EXPECT_EQ(shown_value(metrics, "trajectory.coverage"), 25);
  EXPECT_EQ(shown_value(metrics, "trajectory.poses"), std::nullopt);
}

/// The catalogue as docs/metrics.md shows it.
std::string documented_catalogue() {
  Table table{.columns = {{"key"}, {"better"}, {"unit"}, {"needs"}, {"gate's floor", true}}};
  for (const MetricInfo& metric : metric_catalogue()) {
    const char* better = metric.better == Better::kNeither ? "–"
                         : metric.higher_is_better()       ? "higher"
                                                           : "lower";
    table.add({"`" + metric.key + "`", better, metric.unit, metric.needs,
               metric.floor ? fmt::format("{}", *metric.floor) : ""});
  }
  return table_markdown(table);
}

TEST(Catalogue, StandsInTheDocumentation) {
  EXPECT_THAT(testing::read_file(testing::source_path("docs/metrics.md")),
              ::testing::HasSubstr(documented_catalogue()))
      << "put this table in place of the one of docs/metrics.md:\n"
      << documented_catalogue();
}

}  // namespace
}  // namespace saccade
