// Ways of using the command beside the plain first run.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "core/io/run/run_record.h"
#include "tests/system/saccade_command.h"

namespace saccade::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

std::string simulate_walls(const fs::path& folder, const std::vector<std::string>& overrides) {
  const std::string data = folder / "walls";
  std::vector<std::string> arguments = {"simulate", shipped_config("simulation/walls.yaml"), "-o",
                                        data};
  for (const std::string& key : overrides) arguments.insert(arguments.end(), {"--set", key});
  saccade_ok(arguments);
  return data;
}

/// Tracks with the accurate setting and returns the run folder, scored.
std::string track(const fs::path& folder, const std::string& data,
                  const std::vector<std::string>& more = {}) {
  const std::string run = folder / "run";
  std::vector<std::string> arguments = {
      "run", "track", "--data", data, "-o", run, "-c", shipped_config("tracking/accurate.yaml")};
  arguments.insert(arguments.end(), more.begin(), more.end());
  saccade_ok(arguments);
  saccade_ok({"eval", run});
  return run;
}

void expect_tracked(const fs::path& metrics_file) {
  const Metrics metrics = read_json_metrics(metrics_file);
  EXPECT_LE(score(metrics, "trajectory.dt_rel_percent.mean"), 0.65);
  EXPECT_LE(score(metrics, "trajectory.dtheta_deg.mean"), 0.35);
  EXPECT_GE(score(metrics, "trajectory.coverage"), 0.95);
}

TEST(Variants, ALensIsUndistorted) {
  const TemporaryFolder folder;
  const std::string data = simulate_walls(
      folder.path(), {"duration_s=0.4", "camera.distortion=[-0.3, 0.1, 0.001, -0.001, 0]"});
  expect_tracked(track(folder.path(), data) + "/metrics.json");
}

TEST(Variants, NanosecondsExposureAndSupersamplingChangeNothing) {
  const TemporaryFolder folder;
  const std::string data =
      simulate_walls(folder.path(), {"duration_s=0.3", "events.timestamp_unit=ns",
                                     "frames.exposure_s=0.005", "events.samples_per_pixel=4"});
  expect_tracked(track(folder.path(), data) + "/metrics.json");
}

TEST(Variants, AFurtherCameraOfARigIsADatasetLikeAny) {
  const TemporaryFolder folder;
  const std::string data = simulate_walls(
      folder.path(),
      {"duration_s=0.3",
       "rig=[{T_camera0_camera: [[1, 0, 0, 0.1], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]}]"});
  EXPECT_THAT(saccade_ok({"info", data, "--verify"}),
              AllOf(HasSubstr("2 cameras"), HasSubstr("all files match")));
  EXPECT_THAT(saccade_ok({"info", data + "/cam1", "--verify"}), HasSubstr("all files match"));
  expect_tracked(track(folder.path(), data + "/cam1") + "/metrics.json");
}

TEST(Variants, AWindowIsTrackedFromTheFrameAtItsStart) {
  const TemporaryFolder folder;
  const std::string data = simulate_walls(folder.path(), {"duration_s=0.6"});
  const std::string run =
      track(folder.path(), data, {"--start-s", "0.2", "--duration-s", "0.3", "--seed", "9"});
  expect_tracked(run + "/metrics.json");
  const RunRecord record = read_run_record(run + "/run.yaml");
  EXPECT_EQ(record.seed, 9U);
  ASSERT_TRUE(record.window);
  EXPECT_DOUBLE_EQ(record.window->start_s, 0.2);
  EXPECT_DOUBLE_EQ(record.window->end_s, 0.5);
  EXPECT_NEAR(score(read_json_metrics(run + "/metrics.json"), "trajectory.duration_s"), 0.3, 1e-9);
}

TEST(Variants, ATrajectoryOfAnyProgramIsScored) {
  const TemporaryFolder folder;
  const std::string data = simulate_walls(folder.path(), {"duration_s=0.05"});
  const std::string scores = folder.path() / "scores.json";
  saccade_ok({"eval", "--trajectory", data + "/groundtruth.txt", "--data", data, "-o", scores});
  const Metrics metrics = read_json_metrics(scores);
  EXPECT_NEAR(score(metrics, "trajectory.dt_rel_percent.max"), 0, 1e-6);
  EXPECT_NEAR(score(metrics, "trajectory.dtheta_deg.max"), 0, 1e-5);
  EXPECT_EQ(score(metrics, "trajectory.coverage"), 1);
}

/// A folder as tools for the Event Camera Dataset write it holds no dataset.yaml and no events.h5.
TEST(Variants, TextFilesAloneAreADataset) {
  const TemporaryFolder folder;
  const fs::path data = simulate_walls(folder.path(), {"duration_s=0.3"});
  const fs::path plain = folder.path() / "plain";
  fs::copy(data, plain, fs::copy_options::recursive);
  saccade_ok({"convert", data.string(), (plain / "events.txt").string()});
  for (const char* file : {"dataset.yaml", "events.h5", "camera.yaml"}) fs::remove(plain / file);

  const std::string expected = read_file(track(folder.path(), data) + "/trajectory.txt");
  const std::string run = track(folder.path(), plain);
  EXPECT_TRUE(read_file(run + "/trajectory.txt") == expected);
  const Metrics metrics = read_json_metrics(run + "/metrics.json");
  EXPECT_LE(score(metrics, "trajectory.dtheta_deg.mean"), 0.35);
  EXPECT_FALSE(metrics.get("trajectory.dt_rel_percent.mean")) << "nothing states the mean depth";
}

}  // namespace
}  // namespace saccade::testing
