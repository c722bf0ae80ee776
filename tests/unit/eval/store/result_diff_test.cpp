#include "eval/store/result_diff.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "eval/store/result_text.h"
#include "tests/support/error_of.h"
#include "tests/unit/eval/store/stored_runs.h"

namespace saccade {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using testing::error_of;
using ::testing::HasSubstr;
using testing::kDrift;
using ::testing::Not;
using testing::write_stored_run;

Metrics scores(double drift, double poses_per_s) {
  Metrics metrics = testing::one_metric(kDrift, drift);
  metrics.set("speed.poses_per_s.median", poses_per_s);
  metrics.set("trajectory.nees", std::nullopt);
  return metrics;
}

/// Two commits and two configurations; seed 3 is of the new commit alone.
class Diff : public ::testing::Test {
 protected:
  void SetUp() override {
    add({.name = "old1", .metrics = scores(1, 100)});
    add({.name = "old2", .seed = 2, .metrics = scores(2, 100)});
    add({.name = "new1", .commit = "bbbb", .metrics = scores(0.5, 100)});
    add({.name = "new2", .commit = "bbbb", .seed = 2, .metrics = scores(1.5, 100)});
    add({.name = "new3", .commit = "bbbb", .seed = 3, .metrics = scores(9, 100)});
    add({.name = "fast1", .config = "fast", .metrics = scores(3, 400)});
  }
  void add(const testing::StoredRun& run) { store_result(write_stored_run(folder_.path(), run)); }
  ResultReader reader() { return ResultReader(folder_.path() / kResultStoreName); }
  ResultDiff diff(const std::string& a, const std::string& b, const std::string& where = "") {
    ResultReader from = reader();
    return diff_results(from, a, b, where);
  }
  static ChangeSummary drift_of(const ResultDiff& diff) {
    for (const ChangeSummary& summary : summarise_changes(diff))
      if (summary.metric == kDrift) return summary;
    ADD_FAILURE() << "no drift";
    return {};
  }

  testing::TemporaryFolder folder_;
};

TEST_F(Diff, PairsVariantsOfASweep) {
  ResultReader from = reader();
  const RunVariants variants{
      {"old1", "full"}, {"old2", "full"}, {"new1", "bare"}, {"new2", "bare"}};
  const ResultDiff by_variant = diff_results(from, "full", "bare", "", variants);
  EXPECT_EQ(by_variant.by, "variant");
  EXPECT_EQ(by_variant.pairs.size(), 2U);
  EXPECT_THAT(error_of([&] { return diff_results(from, "full", "bar", "", variants); }),
              HasSubstr("did you mean 'bare'?"));
}

TEST_F(Diff, PairsCommitsBySeed) {
  const ResultDiff by_commit = diff("aaaa1111", "bbbb");
  EXPECT_EQ(by_commit.by, "commit");
  ASSERT_EQ(by_commit.pairs.size(), 2U);
  EXPECT_EQ(by_commit.pairs[1].key.seed, 2U);
  EXPECT_THAT(by_commit.alone, ElementsAre("fast1", "new3"));
  const ChangeSummary drift = drift_of(by_commit);
  EXPECT_EQ(drift.pairs, 2U);
  EXPECT_DOUBLE_EQ(drift.a, 1.5);
  EXPECT_DOUBLE_EQ(drift.b, 1);
  EXPECT_DOUBLE_EQ(drift.median_percent, -37.5);  // of -50 and -25
  EXPECT_EQ(drift.better, 2U);
  EXPECT_EQ(drift.worse, 0U);
}

TEST_F(Diff, SeveralRunsOfOneKeyGiveTheirMean) {
  add({.name = "old1_again", .metrics = scores(4, 100)});
  EXPECT_DOUBLE_EQ(drift_of(diff("aaaa", "bbbb", "seed = 1")).a, 2.5);
}

TEST_F(Diff, ComparesRunsAndConfigurations) {
  const ResultDiff runs = diff("old1", "new3");
  EXPECT_EQ(runs.by, "run");
  EXPECT_DOUBLE_EQ(drift_of(runs).median_percent, 800);
  EXPECT_EQ(drift_of(runs).worse, 1U);
  const ResultDiff configs =
      diff("best align.samples=50", "fast align.samples=50", "commit = 'aaaa11112222'");
  EXPECT_EQ(configs.by, "config");
  ASSERT_EQ(configs.pairs.size(), 1U);
  EXPECT_EQ(configs.pairs[0].changes.size(), 3U);
  EXPECT_THAT(configs.alone, ElementsAre("old2"));
}

TEST_F(Diff, SaysWhatCannotBeCompared) {
  const auto error = [&](const std::string& a, const std::string& b, const std::string& where) {
    return error_of([&] { return diff(a, b, where); });
  };
  EXPECT_THAT(error("odl1", "new1", ""), HasSubstr("did you mean 'old1'?"));
  EXPECT_THAT(error("old1", "bbbb", ""), HasSubstr("are not of one kind"));
  EXPECT_THAT(error("aaaa", "bbbb", "run = 'old1' or run = 'new3'"), HasSubstr("has a partner"));
}

TEST(MetricChange, IsRelativeToTheFirst) {
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ((MetricChange{2, 3}).percent(), 50);
  EXPECT_EQ((MetricChange{-2, -3}).percent(), -50);
  EXPECT_EQ((MetricChange{0, 0}).percent(), 0);
  EXPECT_TRUE(std::isnan((MetricChange{0, 1}).percent()));
  EXPECT_TRUE(std::isnan((MetricChange{1, nothing}).percent()));
  EXPECT_FALSE((MetricChange{1, nothing}).measured());
}

TEST_F(Diff, IsShownInThreeFormats) {
  const ResultDiff runs = diff("old1", "new1");
  EXPECT_EQ(format_diff(runs, ResultFormat::kTable),
            "metric                    pairs  old1   new1    change  better  worse\n"
            "speed.poses_per_s.median      1   100    100   +0.00 %       0      0\n"
            "trajectory.drift_percent      1  1.00  0.500  -50.00 %       1      0\n"
            "1 pair by run; values: means, change: median over the pairs\n");
  EXPECT_THAT(format_diff(runs, ResultFormat::kCsv),
              AllOf(HasSubstr("dataset,module,config,window,seed,metric,a,b,change_percent\n"),
                    HasSubstr("walls,track,best align.samples=50,0.00-2.00,1,"
                              "trajectory.drift_percent,1,0.5,-50\n"),
                    Not(HasSubstr("trajectory.nees"))));
  EXPECT_THAT(format_diff(runs, ResultFormat::kJson),
              AllOf(HasSubstr("{\"a\": \"old1\", \"b\": \"new1\", \"by\": \"run\", \"pairs\": [\n"),
                    HasSubstr("\"trajectory.drift_percent\": {\"a\": 1, \"b\": 0.5, "
                              "\"change_percent\": -50}}}\n], \"alone\": []}\n")));
}

TEST_F(Diff, ResultsAreListedInThreeFormats) {
  ResultReader from = reader();
  const auto shown = [&](const std::vector<std::string>& names, ResultFormat format) {
    return list_results(from, "seed = 1 and commit = 'aaaa11112222'", names, format);
  };
  EXPECT_EQ(shown({}, ResultFormat::kTable),
            "run    dataset  module  config                 seed  commit        poses/s\n"
            "old1   walls    track   best align.samples=50  1     aaaa11112222      100\n"
            "fast1  walls    track   fast align.samples=50  1     aaaa11112222      400\n"
            "2 runs\n");
  EXPECT_EQ(shown({"run", kDrift, "trajectory.nees", "seed"}, ResultFormat::kCsv),
            "run,seed,trajectory.drift_percent,trajectory.nees\nold1,1,1,\nfast1,1,3,\n");
  EXPECT_THAT(shown({}, ResultFormat::kCsv), HasSubstr("run,module,dataset,config,seed,threads"));
  EXPECT_EQ(shown({"run", "end_s", "trajectory.nees"}, ResultFormat::kJson),
            "[\n{\"run\": \"old1\", \"end_s\": 2, \"metrics\": {\"trajectory.nees\": null}},\n"
            "{\"run\": \"fast1\", \"end_s\": 2, \"metrics\": {\"trajectory.nees\": null}}\n]\n");
  EXPECT_THAT(shown({"config_yaml"}, ResultFormat::kCsv), HasSubstr("samples: 50"));
  EXPECT_THAT(error_of([&] { return shown({"rnu"}, ResultFormat::kCsv); }),
              HasSubstr("--columns: 'rnu' is no column and no metric of a stored run; did you mean "
                        "'run'?"));
}

}  // namespace
}  // namespace saccade
