#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include "eval/metrics/trajectory/trajectory_metrics.h"
#include "eval/run_folder.h"
#include "tests/support/command.h"
#include "tests/support/error_of.h"
#include "tests/unit/eval/metrics/hand_made.h"

namespace saccade {
namespace {

using testing::error_of;
using testing::straight;

// What docs/metrics.md states under "Edge cases".

/// On a helix about z.
Rigid3 bent_pose(double t_s) {
  const Eigen::Vector3d position(std::cos(3 * t_s), std::sin(3 * t_s), 0.5 * t_s);
  return {Eigen::Quaterniond(Eigen::AngleAxisd(t_s, Eigen::Vector3d(1, 2, 3).normalized())),
          position};
}

Trajectory bent(const std::vector<double>& times, const Similarity& world = {}) {
  std::vector<StampedPose> poses;
  for (const double t_s : times) poses.push_back({t_s, world * bent_pose(t_s)});
  return Trajectory(std::move(poses));
}

Trajectory bent_truth() {
  std::vector<double> times;
  for (int i = 0; i <= 100; ++i) times.push_back(0.01 * i);
  return bent(times);
}

Metrics scores_of(const Trajectory& estimate, const Trajectory& truth) {
  return score_trajectory(
      {.estimate = estimate, .truth = truth, .window = {}, .mean_depth_m = 1, .reported = {}});
}

/// Another world: its alignment is what few poses must recover.
const Similarity kWorld{
    0.5, Rigid3(Eigen::Quaterniond(Eigen::AngleAxisd(1, Eigen::Vector3d(0, 1, 1).normalized())),
                {1, 2, 3})};

double score_at(const Metrics& metrics, const std::string& key) {
  return metrics.get("trajectory." + key).value_or(std::nan(""));
}

TEST(EdgeCases, NoPoseScoresNullAndCoversNothing) {
  const Metrics m = scores_of({}, bent_truth());
  EXPECT_EQ(score_at(m, "poses"), 0);
  EXPECT_EQ(score_at(m, "coverage"), 0);
  for (const char* key : {"dt_m.mean", "dtheta_deg.max", "none.ate_rmse_m", "sim3.scale",
                          "rpe.per_second.rot_rmse_deg", "drift_percent", "lost_s"})
    EXPECT_FALSE(m.get(std::string("trajectory.") + key)) << key;
}

TEST(EdgeCases, OnePoseIsHeldAndAlignedByItsOrientation) {
  const Metrics m = scores_of(bent({0.5}, kWorld), bent_truth());
  EXPECT_NEAR(score_at(m, "se3.ate_rmse_m"), 0, 1e-12);
  EXPECT_NEAR(score_at(m, "se3.rot_rmse_deg"), 0, 1e-6);
  EXPECT_EQ(score_at(m, "sim3.scale"), 1);
  EXPECT_NEAR(score_at(m, "coverage"), 0.02, 1e-9);
  EXPECT_NEAR(score_at(m, "drift_percent"),
              100 * (bent_pose(0).inverse() * bent_pose(1)).translation().norm() /
                  score_at(m, "path_length_m"),
              1e-6);
}

TEST(EdgeCases, TwoPosesGiveScaleAndTheirOrientationsTheRoll) {
  const Metrics m = scores_of(bent({0.2, 0.8}, kWorld), bent_truth());
  EXPECT_NEAR(score_at(m, "sim3.scale"), 2, 1e-9);
  EXPECT_NEAR(score_at(m, "sim3.ate_rmse_m"), 0, 1e-9);
  EXPECT_NEAR(score_at(m, "sim3.rot_rmse_deg"), 0, 1e-6);
}

TEST(EdgeCases, ThreePosesGiveTheWholeAlignment) {
  const Metrics m = scores_of(bent({0.1, 0.4, 0.9}, kWorld), bent_truth());
  EXPECT_NEAR(score_at(m, "sim3.scale"), 2, 1e-9);
  EXPECT_NEAR(score_at(m, "sim3.ate_rmse_m"), 0, 1e-9);
}

TEST(EdgeCases, PosesOutsideTheTruthAreHeldButNotAligned) {
  const Metrics m = scores_of(bent({5, 5.01, 5.02}), bent_truth());
  EXPECT_EQ(score_at(m, "poses"), 3);
  EXPECT_EQ(score_at(m, "coverage"), 0);
  EXPECT_FALSE(m.get("trajectory.none.ate_rmse_m"));
  EXPECT_FALSE(m.get("trajectory.sim3.scale"));
  EXPECT_TRUE(m.get("trajectory.dt_m.mean"));
}

TEST(EdgeCases, OnAStraightPathTheRollIsThatOfTheOrientations) {
  const Trajectory line = straight(0, 1, 0.01);
  std::vector<StampedPose> poses;
  for (const StampedPose& p : line.poses()) poses.push_back({p.t_s, kWorld * p.world_from_camera});
  const Metrics m = scores_of(Trajectory(poses), line);
  EXPECT_NEAR(score_at(m, "sim3.scale"), 2, 1e-9);
  EXPECT_NEAR(score_at(m, "sim3.rot_rmse_deg"), 0, 1e-6);
  EXPECT_NEAR(score_at(m, "sim3.ate_rmse_m"), 0, 1e-9);
}

TEST(EdgeCases, StampsAndNumbersThatSayNothingAreRefusedWithTheirLine) {
  const testing::TemporaryFolder folder;
  const auto refused = [&](const std::string& second_line) {
    const std::filesystem::path file = folder.path() / "estimate.txt";
    std::ofstream(file) << "0.1 0 0 0 0 0 0 1\n" << second_line << "\n";
    return error_of([&] { return read_estimate(file); });
  };
  const std::string place = "estimate.txt:2";
  for (const char* line : {"0.1 1 0 0 0 0 0 1", "0.05 1 0 0 0 0 0 1", "0.2 nan 0 0 0 0 0 1",
                           "nan 1 0 0 0 0 0 1", "0.2 inf 0 0 0 0 0 1", "0.2 1 0 0 0 0 0 0"})
    EXPECT_NE(refused(line).find(place), std::string::npos) << line << ": " << refused(line);
  EXPECT_EQ(refused("0.2 1 0 0 0 0 0 1"), "no error");
}

}  // namespace
}  // namespace saccade
