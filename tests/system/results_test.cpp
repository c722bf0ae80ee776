// `saccade results` over runs that `saccade eval` scored; the cache of datasets.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>

#include "tests/support/fake_run.h"
#include "tests/system/saccade_command.h"

namespace saccade::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(Results, OfScoredRunsAreListedFilteredAndCompared) {
  const TemporaryFolder folder;
  const std::string root = folder.path(), runs = root + "/sweep/runs";
  write_corner_dataset(root + "/walls", "walls", 0.25, 80);
  write_fake_run(runs + "/good", root + "/walls");
  FakeErrors errors;
  errors.slow_m = 0.04;
  write_fake_run(runs + "/bad", root + "/walls", errors);
  EXPECT_THAT(saccade({"results", runs}).output, HasSubstr("is not there; `saccade eval RUN`"));
  for (const char* run : {"/good", "/bad", "/good"}) saccade_ok({"eval", runs + run, "-q"});

  EXPECT_THAT(saccade_ok({"results", root + "/sweep"}),
              AllOf(HasSubstr("dt_rel [%]"), HasSubstr("\nbad "), HasSubstr("\n2 runs\n")));
  EXPECT_EQ(saccade_ok({"results", runs + "/results.sqlite", "--where",
                        "dataset = 'walls' and trajectory.none.ate_rmse_m < 0.02", "--columns",
                        "run,machine", "--format", "csv"}),
            "run,machine\ngood,\"a machine, 2 cores\"\n");
  EXPECT_THAT(saccade_ok({"results", runs, "--diff", "good", "bad"}),
              AllOf(HasSubstr("trajectory.none.ate_rmse_m"), HasSubstr("1 pair by run")));
  EXPECT_EQ(saccade_ok({"results", "--scan", root}), runs + "/results.sqlite: 2 runs added\n");
  const CommandResult wrong = saccade({"results", runs, "--where", "run = good"});
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_THAT(wrong.output, HasSubstr("--where, character 7: 'good' is no column"));
  EXPECT_EQ(saccade({"results", runs, "--diff", "good", "bda"}).exit_code, 2);
}

TEST(Results, AStoreThatCannotBeWrittenCostsNoScores) {
  const TemporaryFolder folder;
  const std::string root = folder.path();
  write_corner_dataset(root + "/walls", "walls", 0.25, 80);
  write_fake_run(root + "/run", root + "/walls");
  folder.write("results.sqlite", std::string(2000, 'x'));
  EXPECT_THAT(saccade_ok({"eval", root + "/run"}),
              AllOf(HasSubstr("not stored for `saccade results`"), HasSubstr("dt_rel [%]")));
  EXPECT_TRUE(std::filesystem::exists(root + "/run/metrics.json"));
}

TEST(DatasetCache, IsSharedByProgramsAtTheSameTimeAndPruned) {
  const TemporaryFolder folder;
  const std::string root = folder.path();
  const auto simulate = [&](const std::string& name) {
    return saccade_ok({"simulate", shipped_config("simulation/walls.yaml"), "--cached", "-o",
                       root + name, "--threads", "1", "--set", "duration_s=0.013"});
  };
  std::string first, second;
  std::thread other([&] { first = simulate("/a"); });
  second = simulate("/b");
  other.join();
  const auto was_there = [](const std::string& text) {
    return text.find("simulated before") != std::string::npos;
  };
  EXPECT_NE(was_there(first), was_there(second)) << first << second;
  EXPECT_EQ(std::filesystem::canonical(root + "/a"), std::filesystem::canonical(root + "/b"));
  saccade_ok({"info", root + "/a", "--verify"});

  // Written by hand into a link, another dataset takes its place and leaves the cache alone.
  saccade_ok({"simulate", shipped_config("simulation/walls.yaml"), "-o", root + "/b", "--set",
              "duration_s=0.011"});
  EXPECT_FALSE(std::filesystem::is_symlink(root + "/b"));
  EXPECT_THAT(simulate("/a"), HasSubstr("simulated before"));

  EXPECT_THAT(saccade_ok({"cache", "list"}), HasSubstr("  walls\n"));
  EXPECT_THAT(saccade({"cache", "prune"}).output, HasSubstr("say what goes"));
  EXPECT_THAT(saccade_ok({"cache", "prune", "--all", "--dry-run"}), HasSubstr("would be removed"));
  EXPECT_TRUE(std::filesystem::exists(root + "/a/dataset.yaml"));
  EXPECT_THAT(saccade_ok({"cache", "prune", "--all"}), HasSubstr("MB removed"));
  EXPECT_FALSE(std::filesystem::exists(root + "/a/dataset.yaml"));
  EXPECT_THAT(simulate("/a"), Not(HasSubstr("simulated before")));
  EXPECT_TRUE(std::filesystem::exists(root + "/a/dataset.yaml"));
}

}  // namespace
}  // namespace saccade::testing
