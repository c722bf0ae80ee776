// Real input: a recorded sensor, and a recorded hand that moves the simulated one.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "core/io/ply_file.h"
#include "tests/support/shared_data.h"
#include "tests/system/saccade_command.h"

namespace saccade::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

/// Several depths and a narrow field of view: translation and yaw look alike, so the scores are
/// those in the image.
TEST(RealData, SliderIsTrackedFromItsOwnFrame) {
  SACCADE_SHARED_DATA_OR_SKIP(recording, "slider_depth");
  const TemporaryFolder folder;
  const std::string run = (folder.path() / "slider").string();
  const std::string description = saccade_ok({"info", recording.string()});
  for (const char* fact : {"50,000", "240", "180", "339"})
    EXPECT_THAT(description, HasSubstr(fact));
  saccade_ok({"render", recording.string(), "-o", run + "_data.png"});
  EXPECT_TRUE(fs::exists(run + "_data.png"));

  saccade_ok({"run", "track", "--data", recording.string(), "-c",
              shipped_config("tracking/slider_depth.yaml"), "-o", run, "--threads", "1"});
  saccade_ok({"eval", run});
  const Metrics metrics = read_json_metrics(run + "/metrics.json");
  EXPECT_GT(score(metrics, "trajectory.poses"), 10);
  EXPECT_LE(score(metrics, "trajectory.reprojection_px.rms_max"), 3);
  EXPECT_GE(score(metrics, "trajectory.coverage"), 0.9);
  EXPECT_FALSE(metrics.get("trajectory.dt_rel_percent.mean")) << "no depth map gives d";

  saccade_ok({"render", run, "-o", run + ".png"});
  EXPECT_TRUE(fs::exists(run + ".png"));
  saccade_ok({"report", run, "-o", run + ".html"});
  EXPECT_TRUE(fs::exists(run + ".html"));
}

/// Of docs/realism.md: the blind time of a real pixel.
TEST(RealData, SliderIsBlindForMillisecondsAfterAnEvent) {
  SACCADE_SHARED_DATA_OR_SKIP(recording, "slider_depth");
  const TemporaryFolder folder;
  const std::string out = (folder.path() / "statistics").string();
  EXPECT_THAT(saccade_ok({"statistics", recording.string(), "-o", out}),
              AllOf(HasSubstr("0.1 % of gaps are below [us]"), HasSubstr("2,590")));
  for (const char* file : {"statistics.csv", "rates.csv", "gaps.csv", "statistics.png"})
    EXPECT_TRUE(fs::exists(fs::path(out) / file)) << file;
}

/// Books, a box and balls before a board on a wall.
TEST(RealData, SliderHasDepthInLayers) {
  SACCADE_SHARED_DATA_OR_SKIP(recording, "slider_depth");
  const TemporaryFolder folder;
  for (const char* config : {"depth/slider_depth.yaml", "depth/slider_depth_rays.yaml"}) {
    SCOPED_TRACE(config);
    const std::string run = (folder.path() / fs::path(config).stem()).string();
    saccade_ok(
        {"run", "depth", "--data", recording.string(), "-c", shipped_config(config), "-o", run});
    const PointCloud cloud = read_ply(run + "/cloud.ply");
    std::vector<float> depths = cloud.scalars.at(3).values;
    ASSERT_GT(depths.size(), 400U);
    std::sort(depths.begin(), depths.end());
    EXPECT_GT(depths[depths.size() / 100], 0.4F);
    EXPECT_LT(depths[depths.size() * 99 / 100], 3.0F);
    // Nothing stands between the things on the table and the board behind them.
    const auto between = [&](float low, float high) {
      return std::count_if(depths.begin(), depths.end(),
                           [&](float z) { return z > low && z < high; });
    };
    EXPECT_GT(between(0.5F, 1.2F), 200);
    EXPECT_GT(between(1.7F, 2.6F), 50);
    EXPECT_LT(between(1.3F, 1.7F), 20);
  }
}

/// Interpolating the jitter of motion capture would give accelerations of hundreds of m/s^2: the
/// smoothing spline must leave a motion that can be tracked.
TEST(RealData, HandHeldMotionIsNeverLost) {
  SACCADE_SHARED_DATA_OR_SKIP(motion, "trajectories/poster_6dof_handheld.csv");
  const TemporaryFolder folder;
  const std::string data = (folder.path() / "handheld").string();
  const std::string run = (folder.path() / "run").string();
  saccade_ok({"simulate", shipped_config("simulation/walls_handheld.yaml"), "-o", data, "--set",
              "trajectory.file=" + motion.string(), "--set", "duration_s=5", "--set",
              "camera={width: 120, height: 90, fx: 100, fy: 100, cx: 59.5, cy: 44.5}"});
  saccade_ok({"run", "track", "--data", data, "-c", shipped_config("tracking/accurate.yaml"), "-o",
              run, "--threads", "1"});
  saccade_ok({"eval", run});
  const Metrics metrics = read_json_metrics(run + "/metrics.json");
  EXPECT_EQ(score(metrics, "trajectory.lost_s"), 0);
  EXPECT_EQ(score(metrics, "trajectory.reported_lost_s"), 0);
  EXPECT_LE(score(metrics, "trajectory.dt_rel_percent.mean"), 2.5);
  EXPECT_LE(score(metrics, "trajectory.dtheta_deg.mean"), 1.5);
}

}  // namespace
}  // namespace saccade::testing
