// Depth through the command alone: simulate, estimate with true and with tracked poses, score.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "tests/system/saccade_command.h"

namespace saccade::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class DepthCommand : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<TemporaryFolder>();
    saccade_ok({"simulate", shipped_config("simulation/walls.yaml"), "-o", path("walls"), "--set",
                "duration_s=0.4", "-q"});
  }
  static void TearDownTestSuite() { folder_.reset(); }

  [[nodiscard]] static std::string path(const std::string& name) {
    return (folder_->path() / name).string();
  }
  [[nodiscard]] static Metrics metrics_of(const std::string& run) {
    return read_json_metrics(fs::path(path(run)) / "metrics.json");
  }
  static void run_depth(const std::string& run, const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments = {
        "run", "depth",   "--data", path("walls"), "-c", shipped_config("depth/thesis.yaml"),
        "-o",  path(run), "-q"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    saccade_ok(arguments);
    saccade_ok({"eval", path(run)});
  }

 private:
  static inline std::unique_ptr<TemporaryFolder> folder_;
};

TEST_F(DepthCommand, MeetsTheThesisOnWalls) {
  run_depth("true");
  const Metrics metrics = metrics_of("true");
  EXPECT_LT(score(metrics, "depth.rel_median"), 0.015);
  EXPECT_LT(score(metrics, "depth.rel_mean"), 0.03);
  EXPECT_GE(score(metrics, "depth.points"), 800);
  saccade_ok({"report", path("true"), "-o", path("report.html")});
  EXPECT_THAT(read_file(path("report.html")), HasSubstr("relative error of the depth"));
}

TEST_F(DepthCommand, TrackedPosesServeAsWell) {
  saccade_ok({"run", "track", "--data", path("walls"), "-c",
              shipped_config("tracking/accurate.yaml"), "-o", path("tracked"), "-q"});
  run_depth("from_tracked", {"--poses-from", path("tracked")});
  EXPECT_LT(score(metrics_of("from_tracked"), "depth.rel_median"), 0.015);
}

TEST_F(DepthCommand, ScoresDepthOfOtherPrograms) {
  run_depth("own");
  const std::string table =
      saccade_ok({"eval", "--depth", path("own/depth/depth_00000000.exr"), "--data", path("walls"),
                  "--at-s", "0.001", "-o", path("scores.json")});
  EXPECT_THAT(table, HasSubstr("best of 3 x 3"));
  EXPECT_LT(score(read_json_metrics(path("scores.json")), "depth.rel_median"), 0.015);
  EXPECT_THAT(saccade_ok({"eval", "--cloud", path("own/cloud.ply"), "--data", path("walls")}),
              HasSubstr("points in 1 views"));
}

TEST_F(DepthCommand, RefusesWhatItCannotDo) {
  const auto refused = [](const std::vector<std::string>& arguments) {
    const CommandResult result = saccade(arguments);
    EXPECT_EQ(result.exit_code, 2) << result.output;
    return result.output;
  };
  EXPECT_THAT(refused({"run", "track", "--data", path("walls"), "-o", path("no"), "--poses-from",
                       path("walls")}),
              HasSubstr("--poses-from"));
  EXPECT_THAT(refused({"run", "depth", "--data", path("walls"), "-o", path("no"), "--poses-from",
                       path("nowhere.txt")}),
              HasSubstr("nowhere.txt"));
  EXPECT_THAT(refused({"run", "depth", "--data", path("walls"), "-o", path("no"), "--set",
                       "window.duration=0.3"}),
              HasSubstr("duration_s"));
  EXPECT_THAT(refused({"eval", "--depth", "a.exr", "--cloud", "b.ply", "--data", path("walls")}),
              HasSubstr("name one of"));
  EXPECT_THAT(refused({"eval", "--depth", path("none.exr"), "--data", path("walls")}),
              HasSubstr("none.exr"));
  EXPECT_FALSE(fs::exists(path("no")));
}

}  // namespace
}  // namespace saccade::testing
