// `saccade sweep` from its file to its table: made, taken up again, and with a job that fails.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "core/io/tables/csv_reader.h"
#include "tests/system/saccade_command.h"

namespace saccade::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

/// A tenth of a second of Walls on a small sensor, tracked by the fast setting.
fs::path write_sweep(const TemporaryFolder& folder, const std::string& samples) {
  return folder.write(
      "sweep.yaml",
      "title: Tiny\n"
      "datasets:\n"
      "  - simulate: " +
          shipped_config("simulation/walls.yaml") +
          "\n"
          "    set:\n"
          "      duration_s: 0.1\n"
          "      camera: {width: 120, height: 90, fx: 100, fy: 100, cx: 59.5, cy: 44.5}\n"
          "configurations:\n"
          "  - file: " +
          shipped_config("tracking/fast.yaml") +
          "\n"
          "grid: {edges.samples: [" +
          samples +
          "]}\n"
          "seeds: [1, 2]\n");
}

/// The names of the files in a folder that do not belong there for good.
std::vector<std::string> hidden_files(const fs::path& folder) {
  std::vector<std::string> names;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder))
    if (entry.path().filename().string().starts_with('.')) names.push_back(entry.path());
  return names;
}

TEST(Sweep, MakesATableAndGoesOnWhereItWas) {
  const TemporaryFolder folder;
  const std::string out = folder.path() / "out";
  const std::string sweep = write_sweep(folder, "20, 50");
  EXPECT_THAT(saccade_ok({"sweep", sweep, "-o", out, "--dry-run"}),
              AllOf(HasSubstr("run  walls: not done yet\n  saccade simulate "),
                    HasSubstr("run  walls_fast_samples-50_seed-2: its dataset is to be simulated\n"
                              "  saccade run track --data "),
                    HasSubstr("5 jobs: 5 to run, 0 done already\n")));
  EXPECT_FALSE(fs::exists(out));

  EXPECT_THAT(saccade_ok({"sweep", sweep, "-o", out}),
              HasSubstr("5 jobs done, 0 done before, 0 failed"));
  const CsvColumns csv(fs::path(out) / "sweep.csv");
  ASSERT_EQ(csv.rows(), 4U);
  EXPECT_EQ(csv.number(2, csv.require("edges.samples")), 50);
  EXPECT_GT(csv.number(0, csv.require("speed.poses_per_s.median")), 0);
  for (std::size_t row = 0; row < csv.rows(); ++row)
    EXPECT_LT(csv.number(row, csv.require("trajectory.dt_rel_percent.mean")), 5);
  EXPECT_THAT(read_file(out + "/sweep.md"),
              AllOf(HasSubstr("# Tiny"), HasSubstr("| `edges.samples` | seeds | dt_rel [%]"),
                    HasSubstr("| 20 | 2 |"), HasSubstr("](over_edges_samples.png)")));
  EXPECT_TRUE(fs::exists(out + "/over_edges_samples.png"));
  EXPECT_THAT(read_file(out + "/jobs/walls_fast_samples-20_seed-1/log.txt"),
              AllOf(HasSubstr("$ saccade run track"), HasSubstr("$ saccade eval")));
  EXPECT_TRUE(hidden_files(out).empty());

  const auto written = fs::last_write_time(out + "/data/walls/dataset.yaml");
  EXPECT_THAT(saccade_ok({"sweep", sweep, "-o", out}), HasSubstr("0 jobs done, 5 done before"));
  EXPECT_THAT(saccade_ok({"sweep", write_sweep(folder, "20, 30, 50"), "-o", out}),
              HasSubstr("2 jobs done, 5 done before"));
  EXPECT_EQ(fs::last_write_time(out + "/data/walls/dataset.yaml"), written);
  EXPECT_EQ(CsvColumns(fs::path(out) / "sweep.csv").rows(), 6U);
}

TEST(Sweep, AFailingJobIsReportedAndTheOthersGoOn) {
  const TemporaryFolder folder;
  const std::string out = folder.path() / "out";
  const CommandResult result =
      saccade({"sweep", write_sweep(folder, "20, -3"), "-o", out, "--seed", "1"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.output,
              AllOf(HasSubstr("job walls_fast_samples--3_seed-1 failed with exit code 2"),
                    HasSubstr("saccade run track --data "),
                    HasSubstr("saccade: --set edges.samples: -3 is below"),
                    HasSubstr("2 jobs done, 0 done before, 1 failed"), HasSubstr("1 job failed;")));
  EXPECT_THAT(read_file(out + "/sweep.csv"),
              AllOf(HasSubstr(",20,1,ok,"),
                    HasSubstr(",-3,1,refused,refused: --set edges.samples: -3 is below")));
  EXPECT_THAT(read_file(out + "/sweep.md"),
              AllOf(HasSubstr("1 of 2 runs without a result, 0 lost."),
                    HasSubstr("- walls_fast_samples--3_seed-1: refused: --set edges.samples: -3 is "
                              "below")));
  // Once more: what is done stays, what failed is tried again.
  EXPECT_THAT(
      saccade({"sweep", folder.path() / "sweep.yaml", "-o", out, "--seed", "1", "-q"}).output,
      AllOf(HasSubstr("failed with exit code 2"), Not(HasSubstr("jobs done"))));
}

/// Starts a sweep, waits until the file `sign` is there, and asks it to end. Its exit code.
int interrupt(const std::vector<std::string>& arguments, const fs::path& sign) {
  const pid_t child = fork();
  if (child == 0) {
    std::freopen("/dev/null", "w", stderr);
    std::vector<char*> argv{const_cast<char*>(SACCADE_COMMAND)};
    for (const std::string& argument : arguments)
      argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);
    execv(SACCADE_COMMAND, argv.data());
    _exit(127);
  }
  int status = 0;
  bool ended = false;
  while (!fs::exists(sign) && !(ended = waitpid(child, &status, WNOHANG) == child))
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  EXPECT_FALSE(ended) << "it ended before it was interrupted";
  if (ended) return -1;
  kill(child, SIGTERM);
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(Sweep, AnInterruptedOneGoesOnWhereItWas) {
  const TemporaryFolder folder;
  const fs::path out = folder.path() / "out";
  const std::string sweep = write_sweep(folder, "20");
  // So many repetitions that no run ends by itself.
  EXPECT_EQ(interrupt({"sweep", sweep, "-o", out, "--jobs", "1", "--set", "repeat=100000"},
                      out / "jobs/walls_fast_samples-20_seed-1/log.txt"),
            1);
  EXPECT_FALSE(fs::exists(out / "sweep.md"));
  EXPECT_FALSE(fs::exists(out / "runs/walls_fast_samples-20_seed-1"));
  EXPECT_THAT(saccade_ok({"sweep", sweep, "-o", out}), HasSubstr("2 jobs done, 1 done before"));
  EXPECT_TRUE(hidden_files(out).empty());
}

TEST(Sweep, DatasetsAloneAreSimulated) {
  const TemporaryFolder folder;
  const std::string out = folder.path() / "out";
  const std::string sweep = folder.write(
      "sweep.yaml",
      "datasets: [{simulate: " + shipped_config("simulation/walls.yaml") +
          ", set: {duration_s: 0.02, imu: {gyro_noise_density: 0.01}}, seeds: [1, 2]}]\n");
  saccade_ok({"sweep", sweep, "-o", out});
  saccade_ok({"info", out + "/data/walls-2", "--verify"});
  EXPECT_THAT(read_file(out + "/sweep.csv"), HasSubstr("walls-1,walls,1,ok,"));
}

/// Datasets of a fiftieth of a second with drawn thresholds and motions.
std::string write_generation(const TemporaryFolder& folder) {
  return folder.write(
      "generate.yaml",
      "generate:\n"
      "  count: 3\n"
      "  scenes: [{simulate: " +
          shipped_config("simulation/walls.yaml") +
          "}]\n"
          "  set: {camera: {width: 120, height: 90, fx: 100, fy: 100, cx: 59.5, cy: 44.5}}\n"
          "  draw:\n"
          "    events.contrast_on: {uniform: [0.1, 0.3]}\n"
          "    trajectory: {source: random_6dof, duration_s: 0.02, seed: {integer: [1, 999]}}\n");
}

TEST(Sweep, GeneratesDatasetsAndListsThem) {
  const TemporaryFolder folder;
  const std::string out = folder.path() / "out", one = folder.path() / "one";
  const std::string sweep = write_generation(folder);
  EXPECT_THAT(saccade_ok({"sweep", sweep, "-o", out, "--dry-run"}),
              AllOf(HasSubstr("3 datasets: 3 to simulate"), HasSubstr("saccade simulate "),
                    HasSubstr("estimate for 3 datasets, 0.06")));
  EXPECT_FALSE(fs::exists(out));
  EXPECT_THAT(saccade_ok({"sweep", sweep, "-o", out}),
              AllOf(HasSubstr("3 jobs done, 0 done before"), HasSubstr("manifest.json")));
  const CsvColumns csv(fs::path(out) / "manifest.csv");
  ASSERT_EQ(csv.rows(), 3U);
  EXPECT_EQ(csv.text(1, csv.require("path")), "data/dataset-000001");
  EXPECT_EQ(csv.text(1, csv.require("status")), "ok");
  EXPECT_GT(csv.number(1, csv.require("events")), 0);
  const double contrast = csv.number(1, csv.require("events.contrast_on"));
  EXPECT_TRUE(contrast >= 0.1 && contrast <= 0.3) << contrast;
  EXPECT_THAT(saccade_ok({"sweep", sweep, "-o", out}), HasSubstr("0 jobs done, 3 done before"));
  // The second of them alone is the same dataset.
  saccade_ok({"sweep", sweep, "-o", one, "--set", "generate.first=1", "--set", "generate.count=1"});
  EXPECT_EQ(read_file(one + "/data/dataset-000001/dataset.yaml"),
            read_file(out + "/data/dataset-000001/dataset.yaml"));
  const CommandResult bad =
      saccade({"sweep", sweep, "-o", one, "--set", "generate.draw={events.noise.hot.rate: 3}"});
  EXPECT_EQ(bad.exit_code, 2);
  EXPECT_THAT(bad.output, HasSubstr("did you mean 'rate_hz'?"));
}

TEST(Sweep, DividesGeneratedDatasetsAmongSplitsAndShards) {
  const TemporaryFolder folder;
  const std::string out = folder.path() / "out";
  const std::string sweep = write_generation(folder);
  saccade_ok({"sweep", sweep, "-o", out, "--set", "generate.split={train: 2, test: 1}", "--set",
              "generate.shards=2", "--set", "generate.classes=[wall, box]", "--set",
              "generate.set={camera: {width: 60, height: 45, fx: 50, fy: 50}, "
              "groundtruth: {masks_rate_hz: 100, event_labels: true}}"});
  const auto manifest = nlohmann::json::parse(read_file(out + "/manifest.json"));
  EXPECT_EQ(manifest["classes"], nlohmann::json({"wall", "box"}));
  EXPECT_EQ(manifest["scenes"][0]["sha256"].get<std::string>().size(), 64U);
  EXPECT_FALSE(manifest["commit"].get<std::string>().empty());
  std::map<std::string, std::string> paths;
  for (const auto& dataset : manifest["datasets"])
    paths[dataset["split"]] += dataset["path"].get<std::string>() + "\n";
  EXPECT_EQ(paths["train"], read_file(out + "/train.txt"));
  EXPECT_EQ(paths["test"], read_file(out + "/test.txt"));
  EXPECT_EQ(read_file(out + "/val.txt"), "");
  EXPECT_EQ(std::count(paths["train"].begin(), paths["train"].end(), '\n'), 2);
  EXPECT_EQ(manifest["datasets"][1]["path"], "data/shard-01/dataset-000001");
  EXPECT_EQ(manifest["datasets"][2]["path"], "data/shard-00/dataset-000002");
  EXPECT_THAT(read_file(out + "/data/shard-01/dataset-000001/labels.yaml"), HasSubstr("box"));
}

TEST(Sweep, RefusesWhatItCannotDo) {
  const TemporaryFolder folder;
  const std::string sweep = write_sweep(folder, "20");
  const fs::path note = folder.write("thesis/notes.txt", "mine\n");
  const auto error = [&](const std::vector<std::string>& arguments) {
    const CommandResult result = saccade(arguments);
    EXPECT_EQ(result.exit_code, 2) << result.output;
    return result.output;
  };
  EXPECT_THAT(error({"sweep", sweep, "-o", note.parent_path()}), HasSubstr("no sweep"));
  EXPECT_THAT(error({"sweep", sweep, "-o", folder.path() / "out", "--launcher", "cloud"}),
              HasSubstr("valid launchers: local, slurm"));
  EXPECT_THAT(error({"sweep", sweep, "-o", "x", "--slurm-option=partition=long"}),
              HasSubstr("option of sbatch"));
  EXPECT_THAT(error({"sweep", sweep, "-o", "x", "--slurm-jobs-per-task", "0"}),
              HasSubstr("--slurm-jobs-per-task"));
  EXPECT_THAT(error({"sweep", sweep, "-o", "x", "--set", "slurm.jobs_per_task=2"}),
              HasSubstr("--slurm-jobs-per-task"));
  EXPECT_THAT(error({"sweep", sweep}), HasSubstr("-o DIR"));
  EXPECT_THAT(error({"sweep", sweep, "-o", "x", "--set", "repet=2"}),
              HasSubstr("did you mean 'repeat'?"));
}

}  // namespace
}  // namespace saccade::testing
