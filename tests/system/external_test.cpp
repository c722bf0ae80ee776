// Somebody else's estimator beside the built-in ones: run, scored and ranked in one sweep.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

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
  EXPECT_EQ(csv.text(1, status), "ok");
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

}  // namespace
}  // namespace saccade::testing
