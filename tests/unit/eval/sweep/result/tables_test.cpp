#include "eval/sweep/result/tables.h"

#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/io/images/image_file.h"
#include "eval/metrics/catalogue.h"
#include "eval/sweep/result/charts.h"
#include "eval/sweep/result/failures.h"
#include "eval/sweep/result/leaderboards.h"
#include "eval/table/number_text.h"
#include "tests/unit/eval/sweep/sweep_files.h"

namespace saccade {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::read_sweep;
using testing::TemporaryFolder;

/// Two values of the grid, two seeds; the last run failed.
class SweepTables : public ::testing::Test {
 protected:
  void fill(const std::string& axis, const std::string& more = "") {
    sweep_ = read_sweep(folder_,
                        "datasets: [{path: recorded}]\nconfigurations: [{file: fast.yaml}]\n"
                        "grid: {" +
                            axis + "}\nseeds: [1, 2]\n" + more);
    plan_ = plan_sweep(sweep_, folder_.path() / "out");
    const double errors[] = {0.5, 0.7, 0.25, 0};
    const double speeds[] = {20000, 30000, 12345, 0};
    for (std::size_t i = 0; i < plan_.runs.size(); ++i) {
      SweepRow row{&plan_.runs[i], i == 3, {}, "a machine", "0.1"};
      if (!row.failed) {
        row.metrics.set("trajectory.dt_rel_percent.mean", errors[i]);
        row.metrics.set("trajectory.drift_percent", std::nullopt);
        row.metrics.set("speed.poses_per_s.median", speeds[i]);
      }
      results_.rows.push_back(row);
    }
    results_.groups = group_by_seed(results_.rows);
    results_.metrics = {"trajectory.dt_rel_percent.mean", "speed.poses_per_s"};
  }

  TemporaryFolder folder_;
  SweepConfig sweep_;
  SweepPlan plan_;
  SweepResults results_{sweep_, plan_, {}, {}, {}};
};

TEST_F(SweepTables, CsvHoldsOneRowForEachJob) {
  fill("a.b: [1, 2]");
  EXPECT_EQ(sweep_csv(results_).text(),
            "job,dataset,dataset_seed,module,configuration,variant,a.b,seed,status,reason,"
            "speed.poses_per_s.median,trajectory.drift_percent,trajectory.dt_rel_percent.mean\n"
            "recorded_fast_b-1_seed-1,recorded,,track,fast,,1,1,ok,,20000,,0.5\n"
            "recorded_fast_b-1_seed-2,recorded,,track,fast,,1,2,ok,,30000,,0.7\n"
            "recorded_fast_b-2_seed-1,recorded,,track,fast,,2,1,ok,,12345,,0.25\n"
            "recorded_fast_b-2_seed-2,recorded,,track,fast,,2,2,failed,failed,,,\n");
}

TEST_F(SweepTables, AnExternalProgramThatCrashedIsARowWithItsReason) {
  fill("a.b: [1, 2]");
  results_.rows[0].problem = "timed out: after 3 s";
  EXPECT_THAT(sweep_csv(results_).text(),
              HasSubstr("fast,,1,1,timed out,timed out: after 3 s,20000"));
  EXPECT_THAT(sweep_markdown(results_, {}, {}),
              AllOf(HasSubstr("| 1 | 2 (1 failed) | 0.700 | **30,000** |"),
                    HasSubstr("- recorded_fast_b-1_seed-1: timed out: after 3 s\n")));
}

TEST_F(SweepTables, SayWhichErrorsAreAfterAnAlignment) {
  fill("a.b: [1, 2]");
  EXPECT_THAT(sweep_markdown(results_, {}, {}), Not(HasSubstr("alignment")));
  results_.rows[0].metrics.set("trajectory.aligned_freedoms", 7);
  EXPECT_THAT(sweep_markdown(results_, {}, {}), HasSubstr("Errors of fast are after an alignment"));
}

TEST_F(SweepTables, FailuresStandFirstWithTheirReasons) {
  fill("a.b: [1, 2]");
  results_.rows[0].metrics.set("trajectory.lost_s", 0.5);
  results_.rows[0].metrics.set("trajectory.loss.first_s", 0.25);
  results_.rows[0].metrics.set("success", 0);
  results_.rows[3].problem = "refused: data/walls: the events show no motion";
  EXPECT_EQ(status_of(results_.rows[0]), "lost");
  EXPECT_EQ(status_of(results_.rows[1]), "ok");
  EXPECT_EQ(status_of(results_.rows[3]), "refused");
  const std::string page = sweep_markdown(results_, {}, {});
  EXPECT_THAT(page, HasSubstr("## Failures\n1 of 4 runs without a result, 1 lost.\n\n"
                              "- recorded_fast_b-1_seed-1: lost after 0.250 s\n"
                              "- recorded_fast_b-2_seed-2: refused: data/walls: the events show no "
                              "motion (jobs/recorded_fast_b-2_seed-2/log.txt)\n"));
  EXPECT_LT(page.find("## Failures"), page.find("## recorded"));
  EXPECT_THAT(
      sweep_csv(results_).text(),
      AllOf(HasSubstr("fast,,1,1,lost,lost after 0.250 s,"),
            HasSubstr("fast,,2,2,refused,refused: data/walls: the events show no motion,")));
}

TEST_F(SweepTables, WithoutAFailureThereIsNoSuchPart) {
  fill("a.b: [1]");
  EXPECT_THAT(sweep_markdown(results_, {}, {}), Not(HasSubstr("## Failures")));
}

TEST_F(SweepTables, MarkdownAveragesOverSeedsAndMarksTheBest) {
  fill("a.b: [1, 2]", "repeat: 5\ntiming: true\ntitle: Mine\n");
  EXPECT_THAT(
      sweep_markdown(results_, {}, {}),
      AllOf(HasSubstr("# Mine\n"), HasSubstr("medians of 5 repetitions, one run at a time"),
            HasSubstr("| `a.b` | seeds | dt_rel [%] | poses/s |\n|---|---|---:|---:|\n"
                      "| 1 | 2 | 0.600 (0.500–0.700) | **25,000** |\n"
                      "| 2 | 2 (1 failed) | **0.250** | 12,300 |\n"),
            HasSubstr("- recorded_fast_b-2_seed-2: failed (jobs/"), HasSubstr("a machine")));
}

TEST_F(SweepTables, TheSpeedOfALostRunIsNotTheBest) {
  fill("a.b: [1, 2]");
  results_.rows[0].metrics.set("trajectory.lost_s", 0.2);
  EXPECT_THAT(sweep_markdown(results_, {}, {}),
              AllOf(HasSubstr("| 25,000 |"), HasSubstr("| **12,300** |")));
}

TEST_F(SweepTables, ExpectedMetricsAreMetOrMissed) {
  fill("a.b: [1]",
       "expected:\n"
       "  - {configuration: fast, metric: trajectory.dt_rel_percent.mean, at_most: 0.61}\n"
       "  - {configuration: fast, metric: speed.poses_per_s, at_least: 26000}\n"
       "  - {configuration: fast, metric: trajectory.drift_percent, at_most: 1}\n");
  const std::vector<ExpectationResult> expectations = check_expectations(results_);
  ASSERT_EQ(expectations.size(), 3U);
  EXPECT_TRUE(expectations[0].met) << "the mean of both seeds counts";
  EXPECT_FALSE(expectations[1].met);
  EXPECT_FALSE(expectations[2].met) << "nothing measured is nothing met";
  EXPECT_EQ(expectations[2].value, std::nullopt);
  EXPECT_THAT(sweep_markdown(results_, {}, expectations),
              AllOf(HasSubstr("1 of 3 met."),
                    HasSubstr("| fast | recorded | dt_rel [%] | ≤ 0.61 | 0.600 | met |\n"
                              "| fast | recorded | poses/s | ≥ 26000 | 25,000 | **missed** |\n")));
}

TEST_F(SweepTables, ARunThatFailedMeetsNothing) {
  fill("a.b: [1, 2]",
       "expected: [{configuration: fast, metric: trajectory.dt_rel_percent.mean, at_most: 9}]\n");
  const std::vector<ExpectationResult> expectations = check_expectations(results_);
  ASSERT_EQ(expectations.size(), 2U) << "one for each row";
  EXPECT_TRUE(expectations[0].met);
  EXPECT_FALSE(expectations[1].met);
}

TEST_F(SweepTables, ModulesHaveTablesOfTheirOwn) {
  fill("a.b: [1, 2]");
  plan_.runs[2].point.module = plan_.runs[3].point.module = "depth";
  results_.rows[2].metrics = {};
  results_.rows[2].metrics.set("depth.rel_median", 0.01);
  results_.groups = group_by_seed(results_.rows);
  results_.metrics.emplace_back("depth.rel_median");
  EXPECT_THAT(sweep_markdown(results_, {}, {}),
              AllOf(HasSubstr("## recorded\n### track\n| `a.b` | seeds | dt_rel [%] | poses/s |\n"),
                    HasSubstr("### depth\n| `a.b` | seeds | median depth error |\n")));
}

TEST_F(SweepTables, NumbersBecomeALineChart) {
  fill("a.b: [1, 2]");
  const auto charts = write_charts(results_, folder_.path());
  ASSERT_EQ(charts.size(), 1U);
  EXPECT_EQ(charts[0], "![Over a.b](over_a_b.png) ([PDF](over_a_b.pdf), [SVG](over_a_b.svg))");
  EXPECT_GT(std::filesystem::file_size(folder_.path() / "over_a_b.png"), 1000U);
}

TEST_F(SweepTables, WordsBecomeABarChart) {
  fill("a.b: [dense, sparse]");
  const auto charts = write_charts(results_, folder_.path());
  ASSERT_EQ(charts.size(), 1U);
  EXPECT_EQ(charts[0],
            "![All rows compared](compared.png) ([PDF](compared.pdf), [SVG](compared.svg))");
}

TEST_F(SweepTables, ManyDatasetsBecomeRows) {
  fill("a.b: [dense, sparse]");
  (void)write_charts(results_, folder_.path());
  const int of_one_dataset = read_image_rgb(folder_.path() / "compared.png").height();
  plan_.runs[1].point.dataset = "second";
  plan_.runs[3].point.dataset = "third";
  results_.groups = group_by_seed(results_.rows);
  (void)write_charts(results_, folder_.path());
  // Three rows for two bars each; two rows for three bars would be lower by the gap of a row.
  const int of_three = read_image_rgb(folder_.path() / "compared.png").height();
  EXPECT_EQ(of_three - of_one_dataset, 3 * 38 - 2 * 25);
}

TEST_F(SweepTables, ASingleRowHasNoChart) {
  fill("a.b: [1]");
  EXPECT_TRUE(write_charts(results_, folder_.path()).empty());
  EXPECT_THAT(sweep_markdown(results_, {}, {}), Not(HasSubstr("**")));
}

/// A run of each of two datasets, and one that failed.
class PooledTables : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_.write("second/events.txt", "0.1 0 0 1\n");
    sweep_ = read_sweep(folder_,
                        "datasets: [{path: recorded}, {path: second}]\n"
                        "configurations: [{file: fast.yaml}]\nseeds: [1, 2]\n");
    plan_ = plan_sweep(sweep_, folder_.path() / "out");
    for (std::size_t i = 0; i < plan_.runs.size(); ++i)
      results_.rows.push_back({&plan_.runs[i], i == 3, {}, "", ""});
    // A short run that is lost for 0.1 s and reports 0.04 s of it, a long one that reports 0.25 s
    // too much, and one without a loss.
    set(0, {{"lost_s", 0.1}, {"unreported_s", 0.06}, {"reported_s", 0.04}, {"delay_ms", 50}}, 0.5);
    set(1, {{"lost_s", 0.7}, {"unreported_s", 0.0}, {"reported_s", 0.95}, {"delay_ms", 20}}, 4);
    set(2, {{"lost_s", 0.0}, {"unreported_s", 0.0}, {"reported_s", 0.0}}, 0.5);
    results_.rows[2].metrics.set("success", 1);
    results_.groups = group_by_seed(results_.rows);
    results_.metrics = {"trajectory.dt_rel_percent.mean", "trajectory.lost_s"};
  }

  void set(std::size_t row, const std::map<std::string, double>& seconds, double duration_s) {
    Metrics& metrics = results_.rows[row].metrics;
    for (const auto& [key, value] : seconds)
      metrics.set((key == "lost_s" ? "trajectory." : "trajectory.loss.") + key, value);
    metrics.set("trajectory.loss.count", seconds.contains("delay_ms") ? 1 : 0);
    metrics.set("trajectory.duration_s", duration_s);
    metrics.set("trajectory.dt_rel_percent.mean", static_cast<double>(row + 1));
    metrics.set("success", 0);
  }

  TemporaryFolder folder_;
  SweepConfig sweep_;
  SweepPlan plan_;
  SweepResults results_{sweep_, plan_, {}, {}, {}};
};

TEST_F(PooledTables, AddSecondsOfLossBeforeTheyDivide) {
  // 0.74 of 0.8 lost seconds are reported, 0.74 of 0.99 reported ones are true, delay (50 + 20) / 2;
  // 0.06 of 5 s are unreported. One of four runs succeeded: Wilson 4.56 to 69.9 %. Of 1, 2, 3 the
  // mean and the median are 2, the 90th percentile 3.
  EXPECT_THAT(sweep_markdown(results_, {}, {}),
              AllOf(HasSubstr("## Over all 2 datasets\n"),
                    HasSubstr("| configuration | runs | success [%] | lost [% of time] | "
                              "loss recall [%] | loss precision [%] | loss delay [ms] | "
                              "unreported [% of time] | dt_rel [%] mean / median / 90 % |\n"),
                    HasSubstr("| fast | 4 | 25.0 (4.56–69.9) | 16.0 | 92.5 | 74.7 | 35.0 | 1.20 | "
                              "2.00 / 2.00 / 3.00 (3 of 4 runs) |\n")));
}

TEST_F(PooledTables, ASuccessIsAShareOfAllRunsOfAGroup) {
  ASSERT_EQ(results_.groups.size(), 2U);
  const std::optional<MetricSummary> second = summarise(results_.groups[1], "success");
  ASSERT_TRUE(second);
  EXPECT_EQ(second->value, 0.5) << "the run that failed did not succeed";
  EXPECT_EQ(second->count, 2U);
  EXPECT_NEAR(second->low, 0.0945, 1e-4);
  EXPECT_NEAR(second->high, 0.9055, 1e-4);
  EXPECT_EQ(summarise(results_.groups[0], "success")->value, 0);
  results_.rows[1].metrics = {};
  EXPECT_EQ(summarise(results_.groups[0], "success")->count, 1U) << "nothing is known of the other";
}

TEST_F(PooledTables, OneConfigurationHasNoLeaderboard) {
  EXPECT_EQ(sweep_leaderboards(results_), "");
}

/// Two configurations of one class on two datasets, and a third that is refused on one.
TEST(SweepLeaderboard, RanksConfigurationsWithTheirFailures) {
  const TemporaryFolder folder;
  folder.write("second/events.txt", "0.1 0 0 1\n");
  const std::string file =
      "datasets: [{path: recorded}, {path: second}]\n"
      "configurations: [{name: a}, {name: b}, {name: c}]\n";
  const SweepConfig sweep = read_sweep(folder, file);
  const SweepPlan plan = plan_sweep(sweep, folder.path() / "out");
  SweepResults results{sweep, plan, {}, {}, {"trajectory.dt_rel_percent.mean"}};
  const double errors[] = {1, 0.5, 0.25, 4, 0.5, 0};
  for (std::size_t i = 0; i < plan.runs.size(); ++i) {
    SweepRow row{&plan.runs[i], i == 5, {}, "", ""};
    row.threads = 2;
    if (row.failed) {
      row.problem = "refused: no parallax";
    } else {
      row.metrics.set("trajectory.dt_rel_percent.mean", errors[i]);
      row.method_class = MethodClass{{MethodInput::kEvents},
                                     i % 3 == 0 ? Processing::kBatch : Processing::kCausal};
    }
    results.rows.push_back(row);
  }
  results.groups = group_by_seed(results.rows);
  EXPECT_THAT(
      sweep_leaderboards(results),
      AllOf(HasSubstr("| method | inputs | processing | rank | threads | × real time | runs | "
                      "overall | recorded | second |\n"),
            HasSubstr("| b | events | causal | 1 | 2 | – | 2 | **0.500** | 0.500 | **0.500** |\n"
                      "| c | events | causal | 2 | 2 | – | 2 (1 failed) | 0.250 | **0.250** | "
                      "refused |\n"
                      "| a | events | batch | 1 | 2 | – | 2 | 2.00 | 1.00 | 4.00 |\n")));
  const SweepConfig ablation = read_sweep(folder, file + "grid: {k: [1]}\n");
  const SweepResults varied{ablation, plan, results.rows, results.groups, results.metrics};
  EXPECT_EQ(sweep_leaderboards(varied), "") << "values of a key are no methods";
}

TEST(MetricInfo, KnowsWhatIsBetter) {
  using Better = MetricInfo::Better;
  EXPECT_EQ(metric_info("trajectory.dt_rel_percent.max").better, Better::kLower);
  EXPECT_EQ(metric_info("trajectory.coverage").better, Better::kHigher);
  EXPECT_EQ(metric_info("speed.events_per_s.median").better, Better::kHigher);
  EXPECT_EQ(metric_info("speed.wall_s.median").better, Better::kLower);
  EXPECT_EQ(metric_info("trajectory.rpe.per_second.trans_rmse_m").better, Better::kLower);
  EXPECT_EQ(metric_info("trajectory.poses").better, Better::kNeither);
  EXPECT_TRUE(metric_info("speed.wall_s").is_speed);
}

TEST(NumberText, RoundsToThreeDigits) {
  EXPECT_EQ(rounded(0.01234), "0.0123");
  EXPECT_EQ(rounded(1234567.0), "1,230,000");
  EXPECT_EQ(rounded(999.6), "1000");
  EXPECT_EQ(rounded(std::nullopt), "–");
}

}  // namespace
}  // namespace saccade
