#include "eval/store/where_expression.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "eval/store/result_store.h"
#include "tests/support/error_of.h"
#include "tests/unit/eval/store/stored_runs.h"

namespace saccade {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::kDrift;
using testing::one_metric;
using testing::write_stored_run;

/// Three runs: a (walls, drift 0.5), b (planes, drift 2, seed 2), c (it's, not measured).
class Where : public ::testing::Test {
 protected:
  void SetUp() override {
    store_result(
        write_stored_run(folder_.path(), {.name = "a", .metrics = one_metric(kDrift, 0.5)}));
    Metrics b = one_metric(kDrift, 2);
    b.set("speed.wall_s.median", 3);
    store_result(write_stored_run(folder_.path(),
                                  {.name = "b", .dataset = "planes", .seed = 2, .metrics = b}));
    store_result(write_stored_run(
        folder_.path(),
        {.name = "it's", .config = "fast", .commit = "bbbb", .metrics = one_metric(kDrift, {})}));
  }

  std::vector<std::string> runs(const std::string& where) {
    std::vector<std::string> names;
    ResultReader reader(folder_.path() / kResultStoreName);
    for (const ResultRow& row : reader.select(where)) names.push_back(row.run);
    return names;
  }
  std::string error(const std::string& where) {
    return testing::error_of([&] { return runs(where); });
  }

  testing::TemporaryFolder folder_;
};

TEST_F(Where, ComparesColumnsAndMetrics) {
  EXPECT_THAT(runs(""), ElementsAre("b", "a", "it's"));
  EXPECT_THAT(runs("  "), ElementsAre("b", "a", "it's"));
  EXPECT_THAT(runs("dataset = 'walls'"), ElementsAre("a", "it's"));
  EXPECT_THAT(runs("dataset like 'pl%' and module == \"track\""), ElementsAre("b"));
  EXPECT_THAT(runs("trajectory.drift_percent < 1"), ElementsAre("a"));
  EXPECT_THAT(runs("trajectory.drift_percent*2>=1e0"), ElementsAre("b", "a"));
  EXPECT_THAT(runs("trajectory.drift_percent is null"), ElementsAre("it's"));
  EXPECT_THAT(runs("NOT (seed IN (1, 3)) OR commit <> 'aaaa11112222'"), ElementsAre("b", "it's"));
  EXPECT_THAT(runs("seed between 2 and 3"), ElementsAre("b"));
  EXPECT_THAT(runs("trajectory.drift_percent = - - 2"), ElementsAre("b"));
}

TEST_F(Where, AMetricWithoutAValueStandsForItsMedian) {
  EXPECT_THAT(runs("speed.wall_s > 2.5"), ElementsAre("b"));
}

TEST_F(Where, TextIsTextWhateverIsInIt) {
  EXPECT_THAT(runs("run = 'it''s'"), ElementsAre("it's"));
  EXPECT_THAT(runs("run = \"it's\""), ElementsAre("it's"));
  EXPECT_THAT(runs("run = '''; DROP TABLE runs --'"), IsEmpty());
  EXPECT_THAT(runs("run = '?'"), IsEmpty());
}

TEST_F(Where, SaysWhereAConditionIsWrong) {
  EXPECT_EQ(error("module = 'track' and trajectory.drift_prcent < 1"),
            "--where, character 22: 'trajectory.drift_prcent' is no column and no metric of a "
            "stored run; did you mean 'trajectory.drift_percent'? (text goes in quotes)");
  EXPECT_THAT(error("modul = 'track'"), HasSubstr("character 1: 'modul'"));
  EXPECT_THAT(error("abs(seed) = 1"), HasSubstr("character 1: 'abs'"));
  EXPECT_THAT(error("run = walls_of_nobody"), HasSubstr("text goes in quotes"));
  EXPECT_EQ(error("seed = 1 seed = 2"), "--where, character 10: 'seed' does not fit here");
  EXPECT_EQ(error("seed = 1 and"), "--where, character 13: the condition ends too early");
  EXPECT_EQ(error("seed = 1) or (1"), "--where, character 9: this bracket closes nothing");
  EXPECT_EQ(error("((seed = 1)"), "--where, character 1: this bracket is not closed");
  EXPECT_EQ(error("run = 'a"),
            "--where, character 7: the text that begins here has no closing quote");
  EXPECT_EQ(error("seed = 1; DELETE FROM runs"),
            "--where, character 9: ';' has no meaning in a condition");
  EXPECT_THAT(error("seed = (select 1)"), HasSubstr("character 9: 'select'"));
  EXPECT_THAT(error("and"), HasSubstr("character 1: 'and' does not fit here"));
  EXPECT_THAT(error("seed = 1.2.3"), HasSubstr("character 8"));
}

}  // namespace
}  // namespace saccade
