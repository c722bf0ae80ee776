// The same input and seed give the same bytes: once more, and with another number of threads.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "core/io/dataset/dataset_record.h"
#include "tests/system/saccade_command.h"

namespace saccade::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::IsEmpty;
using ::testing::Not;

/// Simulates 0.2 s of Walls for a small camera. The dataset's name is part of its record, so it is
/// the same below every `parent`.
fs::path simulate_small(const fs::path& parent, const std::string& threads) {
  const fs::path data = parent / "walls";
  saccade_ok({"simulate", shipped_config("simulation/walls.yaml"), "-o", data.string(), "--set",
              "duration_s=0.2", "--set",
              "camera={width: 120, height: 90, fx: 100, fy: 100, cx: 59.5, cy: 44.5}", "--set",
              "groundtruth.flow_rate_hz=10", "--threads", threads});
  return data;
}

TEST(Determinism, DatasetHasTheSameBytesForAnyNumberOfThreads) {
  const TemporaryFolder folder;
  const fs::path one = simulate_small(folder.path() / "1", "1");
  const DatasetRecord expected = read_dataset_record(one / "dataset.yaml");
  ASSERT_THAT(expected.sha256, Not(IsEmpty()));
  ASSERT_GT(expected.counts->events_on, 1000);
  for (const std::string threads : {"2", "8"}) {
    SCOPED_TRACE(threads + " threads");
    const fs::path other = simulate_small(folder.path() / threads, threads);
    EXPECT_EQ(read_dataset_record(other / "dataset.yaml").sha256, expected.sha256);
    EXPECT_EQ(read_file(other / "dataset.yaml"), read_file(one / "dataset.yaml"));
  }
}

TEST(Determinism, AnotherSimulationReplacesADatasetByTheSameBytes) {
  const TemporaryFolder folder;
  const std::string first = read_file(simulate_small(folder.path(), "2") / "dataset.yaml");
  EXPECT_EQ(read_file(simulate_small(folder.path(), "2") / "dataset.yaml"), first);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()), 1);
}

TEST(Determinism, TrackHasTheSameBytesAgainAndForAnyNumberOfThreads) {
  const TemporaryFolder folder;
  const fs::path data = simulate_small(folder.path(), "2");
  for (const std::string setting : {"accurate", "fast"}) {
    const auto track = [&](const std::string& name, const std::vector<std::string>& more) {
      const fs::path run = folder.path() / name;
      std::vector<std::string> arguments = {
          "run", "track",      "--data", data.string(),
          "-o",  run.string(), "-c",     shipped_config("tracking/" + setting + ".yaml")};
      arguments.insert(arguments.end(), more.begin(), more.end());
      saccade_ok(arguments);
      return run;
    };
    const fs::path first = track("first", {"--threads", "1", "--seed", "3"});
    const fs::path again = track("again", {"--threads", "1", "--seed", "3"});
    const fs::path parallel = track("parallel", {"--threads", "4", "--seed", "3"});
    const fs::path repeated = track("repeated", {"--seed", "3", "--repeat", "2"});
    const fs::path reseeded = track("reseeded", {"--seed", "4"});
    for (const char* file : {"trajectory.txt", "poses.csv", "map.ply"}) {
      SCOPED_TRACE(setting + ": " + file);
      const std::string expected = read_file(first / file);
      EXPECT_FALSE(expected.empty());
      EXPECT_EQ(read_file(again / file), expected);
      EXPECT_EQ(read_file(parallel / file), expected);
      EXPECT_EQ(read_file(repeated / file), expected);
    }
    EXPECT_NE(read_file(reseeded / "trajectory.txt"), read_file(first / "trajectory.txt"));
  }
}

}  // namespace
}  // namespace saccade::testing
