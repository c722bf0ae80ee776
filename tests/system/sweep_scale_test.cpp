// What sweeps do for many jobs, datasets and methods from outside: halving, quotas, archives, results of other clusters,
// submissions.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/io/tables/csv_reader.h"
#include "tests/support/source_path.h"
#include "tests/system/saccade_command.h"

namespace saccade::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

/// A tenth of a second of Walls on a small sensor; `more` follows in the file.
fs::path write_small_sweep(const TemporaryFolder& folder, const std::string& more) {
  return folder.write(
      "small.yaml",
      "datasets:\n"
      "  - simulate: " +
          shipped_config("simulation/walls.yaml") +
          "\n"
          "    set:\n"
          "      duration_s: 0.1\n"
          "      camera: {width: 120, height: 90, fx: 100, fy: 100, cx: 59.5, cy: 44.5}\n" +
          more);
}

/// Datasets of a hundredth of a second.
fs::path write_small_generation(const TemporaryFolder& folder, int count) {
  return folder.write(
      "generate.yaml",
      "generate:\n  count: " + std::to_string(count) +
          "\n  split: {train: 2, test: 1}\n  shards: 2\n"
          "  scenes: [{simulate: " +
          shipped_config("simulation/walls.yaml") +
          "}]\n"
          "  set: {duration_s: 0.01, camera: {width: 60, height: 45, fx: 50, fy: 50}}\n"
          "  draw: {events.contrast_on: {uniform: [0.1, 0.3]}}\n");
}

TEST(SweepAtScale, HalvingMakesNoRunsOfHopelessRows) {
  const TemporaryFolder folder;
  const std::string out = folder.path() / "out";
  const std::string sweep = write_small_sweep(
      folder, "configurations: [{file: " + shipped_config("tracking/fast.yaml") +
                  "}]\ngrid: {edges.samples: [200, 100, 16, 17]}\nseeds: [1, 2, 3, 4]\n"
                  "halving: {metric: trajectory.dt_rel_percent.mean, first: 1}\n");
  EXPECT_THAT(saccade_ok({"sweep", sweep, "-o", out}), HasSubstr("6 stopped early"));
  EXPECT_THAT(read_file(out + "/sweep.md"),
              AllOf(HasSubstr("## Stopped early"), HasSubstr("| fast, edges.samples 16 |")));
  EXPECT_FALSE(fs::exists(out + "/runs/walls_fast_samples-16_seed-2"));
  EXPECT_TRUE(fs::exists(out + "/runs/walls_fast_samples-200_seed-4"));
  EXPECT_EQ(CsvColumns(fs::path(out) / "sweep.csv").rows(), 10U);
  for (const char* ending : {"png", "pdf", "svg"})
    EXPECT_TRUE(fs::exists(out + "/over_edges_samples." + ending)) << ending;
  // Once more the same decisions come from the results that are there.
  EXPECT_THAT(saccade_ok({"sweep", sweep, "-o", out}),
              AllOf(HasSubstr("0 jobs done, 11 done before"), HasSubstr("6 stopped early")));
  EXPECT_THAT(read_file(out + "/status.html"), Not(HasSubstr("http-equiv=\"refresh\"")));
}

TEST(SweepAtScale, TakesWhatAnotherFolderHasDone) {
  const TemporaryFolder folder;
  const std::string a = folder.path() / "a", b = folder.path() / "b";
  const std::string tail =
      "configurations: [{file: " + shipped_config("tracking/fast.yaml") + "}]\n";
  const std::string one = write_small_sweep(folder, tail + "seeds: [1]\n");
  saccade_ok({"sweep", one, "-o", a});
  const std::string both = write_small_sweep(folder, tail + "seeds: [1, 2]\n");
  EXPECT_THAT(
      saccade_ok({"sweep", both, "-o", b, "--merge", a}),
      AllOf(HasSubstr("2 jobs taken, 0 were there"), HasSubstr("1 jobs done, 2 done before")));
  const std::string name = "/runs/walls_fast_seed-1/";
  EXPECT_EQ(read_file(a + name + "trajectory.txt"), read_file(b + name + "trajectory.txt"));
  EXPECT_EQ(CsvColumns(fs::path(b) / "sweep.csv").rows(), 2U);
  // Another setting is another job, and says so.
  const std::string other = write_small_sweep(folder, tail + "seeds: [1]\nduration_s: 0.05\n");
  const CommandResult result =
      saccade({"sweep", other, "-o", std::string(folder.path() / "c"), "--merge", a});
  EXPECT_EQ(result.exit_code, 0) << result.output;
  EXPECT_THAT(result.output, AllOf(HasSubstr("not taken: walls_fast_seed-1: the command differs"),
                                   HasSubstr("1 jobs taken")));
  // A folder is no source of itself.
  fs::remove(a + "/jobs/walls/job.yaml");
  EXPECT_EQ(saccade({"sweep", one, "-o", a, "--merge", a}).exit_code, 0);
  EXPECT_TRUE(fs::exists(a + "/data/walls/dataset.yaml"));
  EXPECT_NE(saccade({"sweep", one, "-o", a, "--merge", b, "--dry-run"}).exit_code, 0);
  EXPECT_NE(saccade({"sweep", one, "-o", a, "--follow"}).exit_code, 0);
  EXPECT_EQ(
      saccade({"sweep", one, "-o", a, "--merge", std::string(folder.path() / "none")}).exit_code,
      2);
}

TEST(SweepAtScale, PacksBySplitAndShardAndCleansUp) {
  const TemporaryFolder folder;
  const std::string out = folder.path() / "out", packed = folder.path() / "packed";
  const std::string sweep = write_small_generation(folder, 6);
  EXPECT_THAT(saccade({"sweep", sweep, "-o", out, "--pack", packed}).output,
              HasSubstr("no manifest"));
  saccade_ok({"sweep", sweep, "-o", out});
  EXPECT_THAT(saccade_ok({"sweep", sweep, "-o", out, "--pack", packed}),
              HasSubstr("6 datasets in 4 archives, 0 of them up to date"));
  const auto record = nlohmann::json::parse(read_file(packed + "/train-00.json"));
  EXPECT_EQ(record["bytes"], fs::file_size(packed + "/train-00.tar"));
  const std::string name = record["datasets"][0]["name"];
  const CommandResult list = run_command("/usr/bin/env", {"tar", "tf", packed + "/train-00.tar"});
  EXPECT_THAT(list.output, HasSubstr(name + "/events.h5\n"));
  // The same again, byte for byte, and nothing is written twice.
  const std::string bytes = read_file(packed + "/train-00.tar");
  EXPECT_THAT(saccade_ok({"sweep", sweep, "-o", out, "--pack", packed}),
              HasSubstr("4 of them up to date"));
  fs::remove(packed + "/train-00.tar");
  saccade_ok({"sweep", sweep, "-o", out, "--pack", packed});
  EXPECT_EQ(read_file(packed + "/train-00.tar"), bytes);

  std::ofstream(out + "/data/notes.txt") << "mine";
  // Other shards: the datasets move, and their records stay.
  fs::create_directories(out + "/data/dataset-000001");
  std::ofstream(out + "/data/dataset-000001/dataset.yaml") << "stale: 1\n";
  EXPECT_THAT(saccade_ok({"sweep", sweep, "-o", out, "--clean"}), HasSubstr("1 datasets removed"));
  EXPECT_TRUE(fs::exists(out + "/jobs/dataset-000001/job.yaml"));
  const std::string fewer = write_small_generation(folder, 4);
  EXPECT_THAT(saccade_ok({"sweep", fewer, "-o", out, "--clean"}), HasSubstr("2 datasets removed"));
  EXPECT_TRUE(fs::exists(out + "/data/notes.txt"));
  EXPECT_TRUE(fs::exists(out + "/data/shard-01/dataset-000003"));
  EXPECT_FALSE(fs::exists(out + "/data/shard-00/dataset-000004"));
}

TEST(SweepAtScale, KeepsGeneratedDatasetsToTheirQuota) {
  const TemporaryFolder folder;
  const std::string out = folder.path() / "out";
  const std::string sweep = write_small_generation(folder, 30);
  const CommandResult result =
      saccade({"sweep", sweep, "-o", out, "--set", "generate.disk_gb=0.000001"});
  EXPECT_EQ(result.exit_code, 0) << result.output;
  EXPECT_THAT(result.output, HasSubstr("2 datasets take "));
  const CsvColumns csv(fs::path(out) / "manifest.csv");
  EXPECT_EQ(csv.text(29, csv.require("status")), "waiting");
}

TEST(SweepAtScale, ASubmissionIsPreparedRunAndRanked) {
  if (!on_search_path("python3")) GTEST_SKIP() << "the example needs python3";
  const TemporaryFolder folder;
  const std::string out = folder.path() / "out";
  const std::string sweep = write_small_sweep(
      folder, "configurations: [{file: " + shipped_config("tracking/fast.yaml") + "}]\n");
  const std::string script = source_path("examples/external/constant_velocity.py");
  const std::string adapter =
      "name: mine\nprepare: cp " + script +
      " program.py\nfiles: {program: program.py}\n"
      "command: python3 {program} --events {events} --start {groundtruth_start} --out "
      "{out}/trajectory.txt\n"
      "start: {truth_s: 0.02}\nclass: {inputs: [events, start], processing: causal}\n"
      "expected_s: 2\n";
  const fs::path submission = folder.write("mine/adapter.yaml", adapter).parent_path();
  EXPECT_THAT(saccade({"sweep", sweep, "-o", out, "--submission", submission}).output,
              HasSubstr("lacks 'licence'"));
  folder.write("mine/adapter.yaml", adapter + "licence: MIT\n");
  EXPECT_THAT(saccade_ok({"sweep", sweep, "-o", out, "--submission", submission}),
              AllOf(HasSubstr("mine: licence MIT, "), HasSubstr("2 s stated")));
  EXPECT_TRUE(fs::exists(submission / "program.py"));
  EXPECT_THAT(read_file(out + "/sweep.md"), HasSubstr("| mine |"));
  folder.write("mine/adapter.yaml", adapter + "licence: MIT\nprepare: \"false\"\n");
  folder.write("failing/adapter.yaml",
               "command: \"true\"\nprepare: sh -c \"echo no compiler; exit 4\"\nlicence: MIT\n"
               "class: {inputs: [events], processing: batch}\n");
  const CommandResult failed =
      saccade({"sweep", sweep, "-o", out, "--submission", folder.path() / "failing"});
  EXPECT_EQ(failed.exit_code, 2);
  EXPECT_THAT(failed.output, AllOf(HasSubstr("failed with exit code 4"), HasSubstr("no compiler")));
  EXPECT_THAT(saccade({"sweep", sweep, "-o", out, "--submission", folder.path()}).output,
              HasSubstr("holds no adapter.yaml"));
}

TEST(SweepAtScale, AnAdaptersContainerIsCalledWithWhatItMaySee) {
  const TemporaryFolder folder;
  // In place of Apptainer what shows how it is called, and runs the command without a container.
  const fs::path runtime =
      folder.write("bin/apptainer",
                   "#!/bin/bash\necho \"container: $*\"\n"
                   "while [[ $1 != *.sif ]]; do shift; done; shift\nexec \"$@\"\n");
  fs::permissions(runtime, fs::perms::owner_all);
  const std::string before = std::getenv("PATH");
  folder.write("image.sif", "an image");
  const fs::path adapter = folder.write(
      "adapter.yaml", "container: image.sif\ncommand: sh -c \"echo inside > here.txt\"\n");
  const std::string data = folder.path() / "data", run = folder.path() / "run";
  saccade_ok({"simulate", shipped_config("simulation/walls.yaml"), "-o", data, "--set",
              "duration_s=0.02"});
  setenv("PATH", (runtime.parent_path().string() + ":" + before).c_str(), 1);
  saccade_ok({"run", "external", "--data", data, "-c", adapter, "-o", run});
  setenv("PATH", before.c_str(), 1);
  EXPECT_THAT(read_file(run + "/log.txt"),
              AllOf(HasSubstr("container: exec --bind "), HasSubstr(data + ":ro"),
                    HasSubstr("image.sif sh -c")));
  EXPECT_EQ(read_file(run + "/output/here.txt"), "inside\n");
}

TEST(SweepAtScale, ResultsBecomeAnExperimentOfMlflow) {
  const TemporaryFolder folder;
  const std::string out = folder.path() / "out", store = folder.path() / "mlruns";
  saccade_ok({"sweep",
              write_small_sweep(folder, "configurations: [{file: " +
                                            shipped_config("tracking/fast.yaml") + "}]\n"),
              "-o", out});
  EXPECT_THAT(saccade_ok({"results", out, "--format", "mlflow", "-o", store}),
              HasSubstr("wrote 1 run to"));
  EXPECT_TRUE(fs::exists(store + "/530871943702615348/meta.yaml"));
  EXPECT_EQ(saccade({"results", out, "--format", "mlflow"}).exit_code, 2);
  EXPECT_EQ(saccade({"results", out, "-o", store}).exit_code, 2);
}

}  // namespace
}  // namespace saccade::testing
