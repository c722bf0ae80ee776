// Somebody else's estimator beside the built-in ones: run, scored and ranked in one sweep.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "core/io/tables/csv_reader.h"
#include "tests/support/source_path.h"
#include "tests/system/saccade_command.h"

namespace saccade::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

std::string example() { return testing::source_path("examples/external/constant_velocity.yaml"); }

/// The fast tracker, the worked example and a program that crashes, over the begin of Walls on a
/// small sensor.
fs::path write_sweep(const TemporaryFolder& folder) {
  folder.write("broken.yaml",
               "name: broken\n"
               "command: sh -c \"echo no map; exit 3\"\n");
  return folder.write(
      "sweep.yaml",
      "title: Theirs and ours\n"
      "datasets:\n"
      "  - simulate: " +
          shipped_config("simulation/walls.yaml") +
          "\n"
          "    set:\n"
          "      duration_s: 0.6\n"
          "      camera: {width: 120, height: 90, fx: 100, fy: 100, cx: 59.5, cy: 44.5}\n"
          "configurations:\n"
          "  - file: " +
          shipped_config("tracking/fast.yaml") + "\n  - adapter: " + example() +
          "\n"
          "  - adapter: broken.yaml\n"
          "seeds: [1]\n");
}

TEST(ExternalEstimator, IsRankedBesideTheBuiltInOnesAndItsCrashIsARow) {
  if (!on_search_path("python3")) GTEST_SKIP() << "the example needs python3";
  const TemporaryFolder folder;
  const std::string out = folder.path() / "out";
  EXPECT_THAT(saccade_ok({"sweep", write_sweep(folder), "-o", out}),
              HasSubstr("4 jobs done, 0 done before, 0 failed"));
  const CsvColumns csv(fs::path(out) / "sweep.csv");
  ASSERT_EQ(csv.rows(), 3U);
  const std::size_t status = csv.require("status");
  EXPECT_EQ(csv.text(0, status), "ok");
  EXPECT_EQ(csv.text(1, status), "lost");
  EXPECT_EQ(csv.text(2, status), "crashed");
  const std::size_t error = csv.require("trajectory.dt_rel_percent.mean");
  EXPECT_GT(csv.number(1, error), 0);
  EXPECT_LT(csv.number(0, error), csv.number(1, error));
  EXPECT_EQ(csv.number(2, csv.require("trajectory.coverage")), 0);
  EXPECT_THAT(read_file(out + "/sweep.md"),
              AllOf(HasSubstr("| constant_velocity |"), HasSubstr("| fast |"),
                    HasSubstr("walls_broken_seed-1: crashed: exit code 3; log: no map")));
  // Everything that takes a run takes this one.
  const std::string run = out + "/runs/walls_constant_velocity_seed-1";
  EXPECT_THAT(read_file(run + "/run.yaml"),
              AllOf(HasSubstr("module: external"), HasSubstr("\"constant velocity 1.0\"")));
  EXPECT_THAT(saccade_ok({"results", out + "/runs", "--format", "csv"}), HasSubstr("external"));
  saccade_ok({"report", run, "-o", folder.path() / "report.html"});
  EXPECT_THAT(saccade_ok({"info", run}), Not(HasSubstr("error")));
  // Nothing is left to be done.
  EXPECT_THAT(saccade_ok({"sweep", folder.path() / "sweep.yaml", "-o", out}),
              HasSubstr("0 jobs done, 4 done before"));
}

TEST(ExternalSimulator, IsScoredAgainstExactSamplingAndItsCrashIsARow) {
  if (!on_search_path("python3") || std::system("python3 -c 'import numpy' 2> /dev/null") != 0)
    GTEST_SKIP() << "the example needs python3 with numpy";
  const TemporaryFolder folder;
  folder.write("broken.yaml", "command: sh -c \"exit 3\"\noutput: {events: events.txt}\n");
  const std::string simulated = "simulate: " + shipped_config("simulation/walls.yaml");
  const std::string camera = "camera: {width: 40, height: 30, fx: 33, fy: 33, cx: 19.5, cy: 14.5}";
  const std::string file =
      folder.write("sweep.yaml",
                   "datasets:\n"
                   "  - {name: exact, " +
                       simulated + ", set: {duration_s: 0.1, " + camera +
                       ", frames.rate_hz: 1000}}\n"
                       "  - {name: same, " +
                       simulated + ", set: {duration_s: 0.1, " + camera +
                       "}, against: exact}\n"
                       "  - {adapter: " +
                       testing::source_path("examples/external/frame_difference.yaml") +
                       ", against: exact}\n"
                       "  - {adapter: broken.yaml, against: exact}\n");
  const std::string out = folder.path() / "out";
  EXPECT_THAT(saccade_ok({"sweep", file, "-o", out}), HasSubstr("4 jobs done, 0 done before"));
  const CsvColumns csv(fs::path(out) / "sweep.csv");
  ASSERT_EQ(csv.rows(), 4U);
  const std::size_t recall = csv.require("events.recall_100us");
  EXPECT_EQ(csv.number(1, csv.require("events.recall_1us")), 1);
  EXPECT_GT(csv.number(2, recall), 0.3);
  EXPECT_LT(csv.number(2, recall), 1);
  EXPECT_GT(csv.number(2, csv.require("speed.wall_s.median")), 0);
  EXPECT_EQ(csv.number(3, recall), 0);
  EXPECT_EQ(csv.text(3, csv.require("status")), "crashed");
  EXPECT_THAT(read_file(out + "/sweep.md"), HasSubstr("- broken: crashed: exit code 3"));
  EXPECT_THAT(saccade_ok({"sweep", file, "-o", out}), HasSubstr("0 jobs done, 4 done before"));
}

}  // namespace
}  // namespace saccade::testing
