#include "eval/sweep/plan/halving.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/error_of.h"
#include "tests/unit/eval/sweep/sweep_files.h"

namespace saccade {
namespace {

using ::testing::ElementsAre;
using testing::error_of;
using ::testing::HasSubstr;
using testing::read_sweep;
using testing::TemporaryFolder;

/// Variants v0, v1 ... over four seeds of one dataset; v0 is the best.
class HalvingOfASweep : public ::testing::Test {
 protected:
  SweepPlan plan(int variants, const std::string& more = "") {
    std::string list;
    for (int i = 0; i < variants; ++i)
      list += fmt::format("{}{{name: v{}, set: {{a.b: {}}}}}", i == 0 ? "" : ", ", i, i);
    sweep_ = read_sweep(folder_,
                        "datasets: [{path: recorded}]\nconfigurations: [{file: fast.yaml}]\n"
                        "variants: [" +
                            list + "]\nseeds: [1, 2, 3, 4]\n" +
                            "halving: {metric: trajectory.dt_rel_percent.mean, first: 1}\n" + more);
    return plan_sweep(sweep_, folder_.path() / "out");
  }

  /// Ends all runs that were released, with the variant's number as its error.
  static std::vector<std::string> finish(SweepPlan& plan) {
    std::vector<std::string> names;
    for (SweepJob& run : plan.runs) {
      if (run.state != JobState::kPending) continue;
      names.push_back(fmt::format("{}/{}", run.point.variant, *run.point.seed));
      run.state = JobState::kDone;
      std::filesystem::create_directories(run.output);
      std::ofstream(run.scores) << fmt::format(
          "{{\"trajectory\": {{\"dt_rel_percent\": {{\"mean\": {}}}}}}}",
          run.point.variant.substr(1));
    }
    return names;
  }

  TemporaryFolder folder_;
  SweepConfig sweep_;
};

TEST_F(HalvingOfASweep, TheBetterHalfRunsOverTwiceAsManySeeds) {
  SweepPlan plan = this->plan(5);
  Halving halving(*sweep_.halving, "", plan.runs);
  EXPECT_THAT(finish(plan), ElementsAre("v0/1", "v1/1", "v2/1", "v3/1", "v4/1"));
  EXPECT_TRUE(halving.release_next());
  EXPECT_THAT(finish(plan), ElementsAre("v0/2", "v1/2", "v2/2"));
  EXPECT_TRUE(halving.release_next());
  EXPECT_THAT(finish(plan), ElementsAre("v0/3", "v0/4", "v1/3", "v1/4"));
  EXPECT_FALSE(halving.release_next());
  ASSERT_EQ(halving.stopped().size(), 3U);
  EXPECT_EQ(halving.stopped()[0].point.variant, "v3");
  EXPECT_EQ(halving.stopped()[0].rank, 4U);
  EXPECT_EQ(halving.stopped()[0].rows, 5U);
  EXPECT_EQ(halving.stopped()[2].point.variant, "v2");
  EXPECT_EQ(halving.stopped()[2].pairs, 2U);
}

TEST_F(HalvingOfASweep, TheReferenceIsNeverStopped) {
  SweepPlan plan = this->plan(5, "reference: v4\n");
  Halving halving(*sweep_.halving, sweep_.reference, plan.runs);
  finish(plan);
  EXPECT_TRUE(halving.release_next());
  EXPECT_THAT(finish(plan), ElementsAre("v0/2", "v1/2", "v2/2", "v4/2"));
}

TEST_F(HalvingOfASweep, ARunThatCameToNothingIsTheWorst) {
  SweepPlan plan = this->plan(4);
  Halving halving(*sweep_.halving, "", plan.runs);
  finish(plan);
  for (SweepJob& run : plan.runs)
    if (run.point.variant == "v0" && run.state == JobState::kDone) run.state = JobState::kFailed;
  EXPECT_TRUE(halving.release_next());
  EXPECT_THAT(finish(plan), ElementsAre("v1/2", "v2/2"));
}

TEST_F(HalvingOfASweep, AMetricThatNoRunHasIsAnErrorAndNotARanking) {
  SweepPlan plan = this->plan(4);
  HalvingConfig config = *sweep_.halving;
  config.metric = "trajectory.dt_rel_percnt.mean";
  Halving halving(config, "", plan.runs);
  finish(plan);
  EXPECT_THAT(error_of([&] { halving.release_next(); }),
              HasSubstr("did you mean 'trajectory.dt_rel_percent.mean'"));
}

TEST_F(HalvingOfASweep, TwoRowsAreComparedToTheEnd) {
  SweepPlan plan = this->plan(2);
  Halving halving(*sweep_.halving, "", plan.runs);
  while (true) {
    finish(plan);
    if (!halving.release_next()) break;
  }
  EXPECT_TRUE(halving.stopped().empty());
  for (const SweepJob& run : plan.runs) EXPECT_EQ(run.state, JobState::kDone);
}

TEST_F(HalvingOfASweep, GoesNotWithWhatStartsFromAnotherRun) {
  EXPECT_THAT(error_of([&] {
                read_sweep(folder_,
                           "datasets: [{path: recorded}]\nconfigurations: [{file: fast.yaml}, "
                           "{name: b, from: fast}]\nhalving: {metric: success}\n");
              }),
              HasSubstr("goes not with 'b', which starts from another run"));
  EXPECT_THAT(error_of([&] {
                read_sweep(folder_,
                           "datasets: [{path: recorded}]\nconfigurations: [{file: fast.yaml}]\n"
                           "halving: {metric: success}\ntiming: true\n");
              }),
              HasSubstr("goes not with 'timing'"));
}

}  // namespace
}  // namespace saccade
