#include "eval/evaluate.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "eval/score_inputs.h"
#include "tests/unit/eval/fake_folders.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using testing::TemporaryFolder;

class Evaluate : public testing::FakeFolders {};

TEST_F(Evaluate, WritesWhatItReturns) {
  const Metrics metrics = evaluate_run(run());
  EXPECT_EQ(testing::read_file(run() / "metrics.json"), to_json(metrics, recorded_inputs(run())));
  EXPECT_EQ(read_json_metrics(run() / "metrics.json"), metrics);
  EXPECT_EQ(metrics.get("trajectory.poses"), 175);
  EXPECT_GT(*metrics.get("trajectory.coverage"), 0.99);
  EXPECT_GT(*metrics.get("trajectory.dt_rel_percent.mean"), 0);
  EXPECT_LT(*metrics.get("trajectory.dt_rel_percent.mean"), 1);
  EXPECT_GT(*metrics.get("trajectory.reprojection_px.rms"), 0);
  EXPECT_EQ(metrics.get("speed.events"), 812345);
  EXPECT_EQ(speed_value(metrics, "speed.wall_s"), 0.231);
  EXPECT_EQ(speed_value(metrics, "speed.io_s"), 0.184);
}

TEST_F(Evaluate, IsRepeatable) {
  EXPECT_EQ(to_json(evaluate_run(run())), to_json(evaluate_run(run())));
}

TEST_F(Evaluate, ATrajectoryFileScoresAsItsRun) {
  const Metrics of_run = evaluate_run(run());
  TemporaryFolder folder;
  const Metrics of_file =
      evaluate_trajectory(run() / "trajectory.txt", dataset(), folder.path() / "scores.json");
  for (const char* key : {"trajectory.dt_rel_percent.mean", "trajectory.sim3.ate_rmse_m"})
    EXPECT_EQ(of_file.get(key), of_run.get(key));
  EXPECT_EQ(read_json_metrics(folder.path() / "scores.json"), of_file);
}

TEST_F(Evaluate, TheTruthItselfHasNoError) {
  const Metrics metrics = evaluate_trajectory(dataset() / "groundtruth.txt", dataset());
  EXPECT_EQ(metrics.get("trajectory.dt_rel_percent.max"), 0);
  EXPECT_NEAR(*metrics.get("trajectory.se3.ate_rmse_m"), 0, 1e-9);
  EXPECT_NEAR(*metrics.get("trajectory.coverage"), 1, 1e-9);
}

TEST_F(Evaluate, AnotherDepthScalesTheRelativeError) {
  EvaluateOptions options;
  const double d = *evaluate_run(run()).get("trajectory.mean_depth_m");
  const double mean = *evaluate_run(run()).get("trajectory.dt_rel_percent.mean");
  options.mean_depth_m = 2 * d;
  EXPECT_NEAR(*evaluate_run(run(), options).get("trajectory.dt_rel_percent.mean"), mean / 2, 1e-9);
  options.mean_depth_m = -1;
  EXPECT_THROW((void)evaluate_run(run(), options), InputError);
}

TEST_F(Evaluate, WithoutGroundTruthTheSpeedIsLeft) {
  TemporaryFolder folder;
  fs::copy(dataset(), folder.path() / "data", fs::copy_options::recursive);
  fs::remove(folder.path() / "data" / "groundtruth.txt");
  EvaluateOptions options;
  options.dataset = folder.path() / "data";
  const Metrics metrics = evaluate_run(run(), options);
  EXPECT_FALSE(metrics.get("trajectory.dt_rel_percent.mean"));
  EXPECT_FALSE(metrics.get("trajectory.reprojection_px.rms"));
  EXPECT_EQ(metrics.get("trajectory.poses"), 175);
  EXPECT_TRUE(speed_value(metrics, "speed.poses_per_s"));
  (void)evaluate_run(run());
}

TEST_F(Evaluate, AnEstimatorThatFoundNothingScoresNull) {
  TemporaryFolder folder;
  const Metrics metrics =
      evaluate_trajectory(folder.write("empty.txt", "# t tx ty tz qx qy qz qw\n"), dataset());
  EXPECT_EQ(metrics.get("trajectory.poses"), 0);
  EXPECT_EQ(metrics.get("trajectory.coverage"), 0);
  EXPECT_FALSE(metrics.get("trajectory.dt_rel_percent.mean"));
}

TEST_F(Evaluate, RefusesBadInput) {
  TemporaryFolder folder;
  EXPECT_THROW((void)evaluate_run(folder.path()), InputError);
  EXPECT_THROW((void)evaluate_run(dataset()), InputError);
  const auto bad = [&](const std::string& text) {
    EXPECT_THROW((void)evaluate_trajectory(folder.write("bad.txt", text), dataset()), InputError);
  };
  bad("0.1 0 0 0 0 0 0 1\n0.1 0 0 0 0 0 0 1\n");  // the same time twice
  bad("0.1 nan 0 0 0 0 0 1\n");
  bad("0.1 0 0 0 0 0 0\n");
}

TEST_F(Evaluate, TheTableNamesTheScores) {
  const std::string table = format_metrics(evaluate_run(run()), "walls");
  EXPECT_TRUE(table.starts_with("walls\n"));
  for (const char* text : {"dt_rel [%]", "dtheta [deg]", "sim3", "175 poses", "3,516,645 events/s"})
    EXPECT_NE(table.find(text), std::string::npos) << table;
}

TEST(FormatMetrics, ShowsADashForWhatIsMissing) {
  Metrics metrics;
  metrics.set("trajectory.poses", 0);
  EXPECT_NE(format_metrics(metrics, "x").find("–"), std::string::npos);
}

}  // namespace
}  // namespace saccade
