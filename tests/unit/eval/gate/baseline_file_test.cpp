#include "eval/gate/baseline_file.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/io/run/run_record.h"
#include "eval/metrics/metrics.h"
#include "tests/support/command.h"
#include "tests/support/error_of.h"
#include "tests/unit/eval/gate/gate_runs.h"

namespace saccade {
namespace {

using testing::error_of;
using testing::FakeScores;
using ::testing::HasSubstr;
using testing::read_file;
using testing::TemporaryFolder;

/// A run folder with as much in it as the gate reads.
std::filesystem::path write_run(const TemporaryFolder& folder, const std::string& name,
                                std::uint64_t seed, bool scored = true) {
  RunRecord record;
  record.module = "track";
  record.dataset = folder.path() / "data/walls";
  record.seed = seed;
  record.threads = 2;
  record.machine = "AMD EPYC, 8 cores, Linux 6.18.44";
  record.command =
      "saccade run track --data data/walls -c 'my configs/best.yaml' --set align.samples=9";
  std::filesystem::create_directories(folder.path() / name);
  write_run_record(folder.path() / name / "run.yaml", record);
  if (scored)
    folder.write(name + "/metrics.json",
                 R"({"trajectory": {"dt_rel_percent": {"mean": 0.25}, "nees": null},
                     "speed": {"wall_s": {"median": 0.5}, "io_s": 3, "events": 7}})");
  return folder.path() / name;
}

TEST(GateRun, IsReadFromARunFolder) {
  const TemporaryFolder folder;
  const GateRun run = read_gate_run(write_run(folder, "run", 3));
  EXPECT_EQ(run.key.text(), "walls, track best align.samples=9, seed 3");
  EXPECT_EQ(run.machine, "AMD EPYC, 8 cores, Linux");
  EXPECT_EQ(run.threads, 2);
  EXPECT_EQ(run.get("trajectory.dt_rel_percent.mean"), 0.25);
  EXPECT_TRUE(run.metrics.contains("trajectory.nees"));
  EXPECT_EQ(run.get("trajectory.nees"), std::nullopt);
  EXPECT_EQ(run.get("speed.wall_s.median"), 0.5);
  EXPECT_FALSE(run.metrics.contains("speed.io_s"));
}

TEST(GateRun, MustHaveBeenScored) {
  const TemporaryFolder folder;
  const std::filesystem::path run = write_run(folder, "run", 3, false);
  EXPECT_THAT(error_of([&] { return read_gate_run(run); }),
              HasSubstr("has not been scored; first: saccade eval " + run.string()));
}

TEST(GateRun, TwoOfOneKeyAreAnError) {
  const TemporaryFolder folder;
  const auto first = write_run(folder, "a", 3), second = write_run(folder, "b", 3);
  EXPECT_THAT(error_of([&] {
                return read_gate_runs({first, second});
              }),
              HasSubstr("has the same key as " + first.string()));
  EXPECT_EQ(read_gate_runs({first, write_run(folder, "c", 4)}).size(), 2U);
}

TEST(Baseline, SurvivesTheFile) {
  const TemporaryFolder folder;
  const std::vector<GateRun> runs = FakeScores().runs();
  write_baseline(folder.path() / "a.yaml", runs);
  const std::vector<GateRun> again = read_baseline(folder.path() / "a.yaml");
  ASSERT_EQ(again.size(), runs.size());
  for (const GateRun& run : runs) {
    const auto found = std::find_if(again.begin(), again.end(),
                                    [&](const GateRun& one) { return one.key == run.key; });
    ASSERT_NE(found, again.end());
    EXPECT_EQ(found->metrics, run.metrics);
    EXPECT_EQ(found->machine, run.machine);
    EXPECT_EQ(found->threads, run.threads);
    EXPECT_EQ(found->tool_version, run.tool_version);
  }
}

TEST(Baseline, IsSortedWhateverTheOrderOfTheRuns) {
  const TemporaryFolder folder;
  std::vector<GateRun> runs = FakeScores().runs();
  write_baseline(folder.path() / "a.yaml", runs);
  std::reverse(runs.begin(), runs.end());
  write_baseline(folder.path() / "b.yaml", runs);
  EXPECT_EQ(read_file(folder.path() / "a.yaml"), read_file(folder.path() / "b.yaml"));
}

TEST(Baseline, HasOneNumberALine) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "a.yaml";
  GateRun run;
  run.key = {"walls", "track", "best", 1};
  run.machine = "a processor, Linux";
  run.threads = 1;
  run.tool_version = "0.1.0 (test)";
  run.metrics = {{"trajectory.lost_s", 0.0}, {"trajectory.nees", std::nullopt}};
  write_baseline(file, {run});
  EXPECT_EQ(read_file(file),
            "format_version: 1\nruns:\n  - dataset: walls\n    module: track\n    config: best\n"
            "    seed: 1\n    machine: \"a processor, Linux\"\n    threads: 1\n"
            "    tool_version: \"0.1.0 (test)\"\n    metrics:\n      trajectory.lost_s: 0\n"
            "      trajectory.nees: ~\n");
}

struct Malformed {
  const char* text;
  const char* error;
};

class MalformedBaseline : public ::testing::TestWithParam<Malformed> {};

TEST_P(MalformedBaseline, IsAnErrorWithItsPlace) {
  const TemporaryFolder folder;
  const auto file = folder.write("base.yaml", GetParam().text);
  EXPECT_THAT(error_of([&] { return read_baseline(file); }), HasSubstr(GetParam().error));
}

INSTANTIATE_TEST_SUITE_P(
    Samples, MalformedBaseline,
    ::testing::Values(
        Malformed{"", "format_version"}, Malformed{"format_version: 2\nruns: []\n", "base.yaml:1"},
        Malformed{"format_version: 1\nruns: []\n", "must not be empty"},
        Malformed{"format_version: 1\nruns:\n  - {dataset: a, module: b, config: c, metrics: {}}\n",
                  "seed"},
        Malformed{"format_version: 1\nruns:\n  - {dataset: a, module: b, config: c, seed: 1,\n"
                  "     metrics: {x: fast}}\n",
                  "base.yaml:4"},
        Malformed{"format_version: 1\nruns:\n  - {dataset: a, module: b, config: c, seed: 1,\n"
                  "     metrics: {x: .nan}}\n",
                  "base.yaml:4"},
        Malformed{"format_version: 1\nruns:\n"
                  "  - {dataset: a, module: b, config: c, seed: 1, metrics: {}}\n"
                  "  - {dataset: a, module: b, config: c, seed: 1, metrics: {}}\n",
                  "holds a, b c, seed 1 twice"},
        Malformed{"format_version: 1\nrun: 3\n", "did you mean 'runs'"}));

GateRun made_on(const std::string& machine, const std::string& config, double wall_s) {
  GateRun run;
  run.key = {"walls", "track", config, 1};
  run.machine = machine;
  run.threads = 1;
  run.metrics = {{"trajectory.drift_percent", 1.0}, {"speed.wall_s.median", wall_s}};
  return run;
}

TEST(Baseline, KeepsTheTimesOfOtherMachines) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "baseline.yaml";
  update_baseline(file, {made_on("fast", "best", 1)}, false);
  update_baseline(file, {made_on("slow", "best", 3)}, false);
  update_baseline(file, {made_on("slow", "best", 4)}, false);
  std::vector<GateRun> baseline = read_baseline(file);
  ASSERT_EQ(baseline.size(), 1U);
  EXPECT_EQ(baseline[0].machine, "slow");
  EXPECT_EQ(baseline[0].get("speed.wall_s.median"), 4);
  ASSERT_EQ(baseline[0].elsewhere.size(), 1U);
  const std::vector<GateRun> runs{made_on("fast", "best", 1.1)};
  take_times_of_same_machine(baseline, runs);
  EXPECT_EQ(baseline[0].machine, "fast");
  EXPECT_EQ(baseline[0].get("speed.wall_s.median"), 1);
  EXPECT_EQ(baseline[0].get("trajectory.drift_percent"), 1);
  EXPECT_EQ(baseline[0].elsewhere[0].machine, "slow");
}

TEST(Compared, SettingsAreLeftOutOfTheKeys) {
  std::vector<GateRun> baseline{made_on("m", "best align.samples=50 grid=[1, 2]", 1)};
  std::vector<GateRun> runs{made_on("m", "best align.samples=200 grid=[1, 2], estimated poses", 1)};
  leave_out_compared(baseline, runs, {"align"});
  EXPECT_EQ(baseline[0].key.config, "best grid=[1, 2]");
  EXPECT_EQ(runs[0].key.config, "best grid=[1, 2], estimated poses");
  leave_out_compared(baseline, runs, {"config", "grid"});
  EXPECT_EQ(runs[0].key.config, "(any), estimated poses");
}

TEST(Compared, AValueMayHoldBlanksAndCommas) {
  std::vector<GateRun> baseline{made_on("m", "best grid=[1, 2] name=a, b", 1)};
  std::vector<GateRun> runs{
      made_on("m", "best grid=[1, 2] name=c = d, estimated poses, smoothed poses", 1)};
  leave_out_compared(baseline, runs, {"name"});
  EXPECT_EQ(baseline[0].key.config, "best grid=[1, 2]");
  EXPECT_EQ(runs[0].key.config, "best grid=[1, 2], estimated poses, smoothed poses");
}

TEST(Compared, UnknownAndAmbiguousSettingsAreErrors) {
  std::vector<GateRun> baseline{made_on("m", "best align.samples=50", 1)};
  std::vector<GateRun> runs{made_on("m", "best align.samples=20", 1),
                            made_on("m", "best align.samples=30", 1)};
  EXPECT_THAT(error_of([&] { leave_out_compared(baseline, runs, {"align.sample"}); }),
              HasSubstr("did you mean 'align.samples'?"));
  EXPECT_THAT(error_of([&] { leave_out_compared(baseline, runs, {"align.samples"}); }),
              HasSubstr("two runs of the call then do the same work"));
}

}  // namespace
}  // namespace saccade
