#include "eval/metrics/trajectory/trajectory_metrics.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "eval/metrics/trajectory/loss_metrics.h"
#include "tests/unit/eval/metrics/hand_made.h"

namespace saccade {
namespace {

using testing::joined;
using testing::straight;

double value(const Metrics& metrics, const std::string& key) {
  const std::optional<double> v = metrics.get("trajectory." + key);
  EXPECT_TRUE(v) << key;
  return v.value_or(std::nan(""));
}

TEST(ScoreTrajectory, AConstantOffset) {
  const Metrics m = score_trajectory({.estimate = straight(0, 2, 0.01, 1, {0, 0.02, 0}),
                                      .truth = straight(0, 2, 0.01),
                                      .window = {},
                                      .mean_depth_m = 2,
                                      .reported = {}});
  EXPECT_NEAR(value(m, "dt_rel_percent.mean"), 1, 1e-9);
  EXPECT_NEAR(value(m, "dt_rel_percent.sigma"), 0, 1e-9);
  EXPECT_NEAR(value(m, "dt_rel_percent.max"), 1, 1e-9);
  EXPECT_NEAR(value(m, "dt_rel_percent.rmse"), 1, 1e-9);
  EXPECT_NEAR(value(m, "dtheta_deg.max"), 0, 1e-9);
  EXPECT_NEAR(value(m, "none.ate_rmse_m"), 0.02, 1e-12);
  EXPECT_NEAR(value(m, "se3.ate_rmse_m"), 0, 1e-9);
  EXPECT_NEAR(value(m, "sim3.scale"), 1, 1e-9);
  EXPECT_EQ(value(m, "none.scale"), 1);
  EXPECT_EQ(value(m, "poses"), 201);
  EXPECT_NEAR(value(m, "coverage"), 1, 1e-12);
  EXPECT_NEAR(value(m, "path_length_m"), 2, 1e-9);
  EXPECT_EQ(value(m, "lost_s"), 0);
  EXPECT_FALSE(m.get("trajectory.reported_lost_s"));
}

TEST(ScoreTrajectory, AGrowingErrorOnTheMillisecondGrid) {
  // 1 % too fast over 1 s: error 1e-5 k metres at sample k = 0..1000. sum k = 1000 1001 / 2 and
  // sum k^2 = 1000 1001 2001 / 6 over 1001 samples: means 500 and 333500.
  const Metrics m = score_trajectory({.estimate = straight(0, 1, 0.01, 1.01),
                                      .truth = straight(0, 1, 0.01),
                                      .window = {},
                                      .mean_depth_m = 1,
                                      .reported = {}});
  EXPECT_NEAR(value(m, "dt_rel_percent.mean"), 0.5, 1e-9);
  EXPECT_NEAR(value(m, "dt_rel_percent.rmse"), 1e-3 * std::sqrt(333500.0), 1e-9);
  EXPECT_NEAR(value(m, "dt_rel_percent.sigma"), 1e-3 * std::sqrt(333500.0 - 250000.0), 1e-9);
  EXPECT_NEAR(value(m, "dt_rel_percent.max"), 1, 1e-9);
  EXPECT_NEAR(value(m, "sim3.scale"), 1 / 1.01, 1e-9);
  EXPECT_NEAR(value(m, "sim3.ate_rmse_m"), 0, 1e-9);
  EXPECT_NEAR(value(m, "drift_percent"), 1, 1e-9);
}

TEST(ScoreTrajectory, FrameDensityDoesNotWeigh) {
  // Twice as many poses in the good half change the mean over poses, not the mean over time.
  const Trajectory truth = straight(0, 1, 0.01);
  const Trajectory bad_half = straight(0.51, 1, 0.01, 1, {0, 0.1, 0});
  const auto mean = [&](double step_s) {
    return value(score_trajectory({.estimate = joined(straight(0, 0.5, step_s), bad_half),
                                   .truth = truth,
                                   .window = {},
                                   .mean_depth_m = 1,
                                   .reported = {}}),
                 "dt_rel_percent.mean");
  };
  EXPECT_NEAR(mean(0.01), mean(0.001), 1e-9);
}

TEST(ScoreTrajectory, LeavingPosesOutScoresTheHeldPose) {
  const Metrics m =
      score_trajectory({.estimate = joined(straight(0, 0.5, 0.01), straight(1, 1, 0.01)),
                        .truth = straight(0, 1, 0.01),
                        .window = {},
                        .mean_depth_m = 1,
                        .reported = {}});
  EXPECT_NEAR(value(m, "dt_rel_percent.max"), 49.9, 1e-6);  // at 0.999 s, held since 0.5 s
  EXPECT_NEAR(value(m, "coverage"), 0.52, 1e-9);
  EXPECT_NEAR(value(m, "none.ate_rmse_m"), 0, 1e-12);  // over poses: blind to the gap
  // Above 5 % from 0.551 s (the sample at 0.55 is a tie broken by rounding) to 0.999 s.
  EXPECT_NEAR(value(m, "lost_s"), 0.449, 0.0015);
}

TEST(ScoreTrajectory, GapsAtTheEndsOfTheWindowCount) {
  const Metrics m = score_trajectory({.estimate = straight(0.3, 0.8, 0.01),
                                      .truth = straight(0, 1, 0.01),
                                      .window = RunRecord::Window{0, 1},
                                      .mean_depth_m = 1,
                                      .reported = {}});
  EXPECT_NEAR(value(m, "coverage"), 0.52, 1e-9);
  EXPECT_NEAR(value(m, "dt_rel_percent.max"), 30, 1e-9);
}

TEST(ScoreTrajectory, OnlyTheWindowIsScored) {
  const Metrics m = score_trajectory({.estimate = straight(0.2, 0.5, 0.01),
                                      .truth = straight(0, 1, 0.01),
                                      .window = RunRecord::Window{0.2, 0.5},
                                      .mean_depth_m = 1,
                                      .reported = {}});
  EXPECT_NEAR(value(m, "coverage"), 1, 1e-9);
  EXPECT_NEAR(value(m, "duration_s"), 0.3, 1e-9);
  EXPECT_NEAR(value(m, "path_length_m"), 0.3, 1e-9);
}

TEST(ScoreTrajectory, RotationErrorAndItsAlignment) {
  const Eigen::Quaterniond turn(
      Eigen::AngleAxisd(2 * std::numbers::pi / 180, Eigen::Vector3d::UnitX()));
  std::vector<StampedPose> poses;
  const Trajectory line = straight(0, 1, 0.01);
  for (const StampedPose& p : line.poses())
    poses.push_back({p.t_s, Rigid3(turn, p.world_from_camera.translation())});
  const Metrics m = score_trajectory({.estimate = Trajectory(poses),
                                      .truth = straight(0, 1, 0.01),
                                      .window = {},
                                      .mean_depth_m = {},
                                      .reported = {}});
  EXPECT_NEAR(value(m, "dtheta_deg.mean"), 2, 1e-9);
  EXPECT_NEAR(value(m, "none.rot_rmse_deg"), 2, 1e-9);
  // About the line of the positions the orientations decide: the alignment takes the turn out.
  EXPECT_NEAR(value(m, "se3.rot_rmse_deg"), 0, 1e-4);
}

TEST(ScoreTrajectory, WithoutDepthRelativeErrorsAreNull) {
  const Metrics m = score_trajectory({.estimate = straight(0, 1, 0.01),
                                      .truth = straight(0, 1, 0.01),
                                      .window = {},
                                      .mean_depth_m = {},
                                      .reported = {}});
  EXPECT_FALSE(m.get("trajectory.dt_rel_percent.mean"));
  EXPECT_FALSE(m.get("trajectory.lost_s"));
  EXPECT_TRUE(m.get("trajectory.dt_m.mean"));
}

TEST(ScoreTrajectory, HasTheSameKeysWhateverIsMissing) {
  const Trajectory truth = straight(0, 1, 0.01);
  const Metrics full = score_trajectory({.estimate = truth,
                                         .truth = truth,
                                         .window = {},
                                         .mean_depth_m = 1,
                                         .reported = std::vector<PoseStatus>{}});
  const std::vector<TrajectoryScoreInput> poor{
      {.estimate = truth, .truth = {}, .window = {}, .mean_depth_m = {}, .reported = {}},
      {.estimate = {}, .truth = truth, .window = {}, .mean_depth_m = 1, .reported = {}},
      {.estimate = truth,
       .truth = truth,
       .window = RunRecord::Window{5, 6},
       .mean_depth_m = 1,
       .reported = {}},
      {.estimate = straight(0.5, 0.5, 1),
       .truth = truth,
       .window = {},
       .mean_depth_m = 1,
       .reported = {}},
      {.estimate = straight(0.5, 0.5, 1),
       .truth = straight(0.5, 0.5, 1),
       .window = {},
       .mean_depth_m = 1,
       .reported = {}}};
  for (const TrajectoryScoreInput& input : poor) {
    const Metrics metrics = score_trajectory(input);
    ASSERT_EQ(metrics.values().size(), full.values().size());
    for (const auto& [key, ignored] : full.values())
      EXPECT_TRUE(metrics.values().contains(key)) << key;
  }
  EXPECT_EQ(score_trajectory(poor[0]).get("trajectory.poses"), 101);
  EXPECT_EQ(score_trajectory(poor[1]).get("trajectory.coverage"), 0);
  EXPECT_FALSE(score_trajectory(poor[1]).get("trajectory.dt_rel_percent.mean"));
}

TEST(ReportedLost, IsTheTimeUntilTheNextGoodPose) {
  const std::vector<PoseStatus> reported{
      {0.1, false}, {0.2, true}, {0.3, true}, {0.45, false}, {0.8, true}};
  EXPECT_NEAR(reported_lost_s(reported, {0, 1}), 0.25 + 0.2, 1e-12);
  EXPECT_NEAR(reported_lost_s(reported, {0.25, 0.9}), 0.2 + 0.1, 1e-12);
  EXPECT_EQ(reported_lost_s({}, {0, 1}), 0);
}

TEST(ErrorSeries, FollowsTheGrid) {
  const ErrorSeries series = errors_over_time({.estimate = straight(0, 1, 0.01, 1.01),
                                               .truth = straight(0, 1, 0.01),
                                               .window = {},
                                               .mean_depth_m = 2,
                                               .reported = {}});
  ASSERT_EQ(series.t_s.size(), 1001U);
  EXPECT_NEAR(series.dt_m[500], 0.005, 1e-9);
  EXPECT_NEAR(series.dt_rel_percent[500], 0.25, 1e-9);
}

/// On a bent path, as an estimate in another world has it: truth = moved * estimate.
TrajectoryScoreInput in_another_world(const Similarity& moved) {
  const Rigid3 back = moved.rigid.inverse();
  std::vector<StampedPose> truth, estimate;
  for (int i = 0; i <= 100; ++i) {
    const double t_s = 0.01 * i;
    const Rigid3 pose(so3_exp({0.2 * t_s, 0.1, 0}),
                      {std::cos(3 * t_s), std::sin(3 * t_s), 0.5 * t_s * t_s});
    truth.push_back({t_s, pose});
    estimate.push_back({t_s, Rigid3(back.rotation() * pose.rotation(),
                                    (back * pose.translation()) / moved.scale)});
  }
  return {.estimate = Trajectory(estimate),
          .truth = Trajectory(truth),
          .window = {},
          .mean_depth_m = 2,
          .reported = {{{0, false}}}};
}

TEST(ScoreTrajectory, AWorldOfItsOwnIsAlignedFirst) {
  TrajectoryScoreInput input =
      in_another_world({3, Rigid3(so3_exp({0.3, 1.2, -0.7}), {1, -2, 0.5})});
  EXPECT_GT(value(score_trajectory(input), "lost_s"), 0.9) << "unless somebody says so";
  EXPECT_FALSE(score_trajectory(input).get("trajectory.aligned_freedoms"));
  input.freedom = Alignment::kSim3;
  const Metrics m = score_trajectory(input);
  EXPECT_NEAR(value(m, "dt_rel_percent.max"), 0, 1e-6);
  EXPECT_NEAR(value(m, "dtheta_deg.max"), 0, 1e-5);
  EXPECT_NEAR(value(m, "drift_percent"), 0, 1e-6);
  EXPECT_NEAR(value(m, "rpe.length_20_percent.trans_percent"), 0, 1e-6);
  EXPECT_EQ(value(m, "lost_s"), 0);
  EXPECT_EQ(value(m, "aligned_freedoms"), 7);
  EXPECT_NEAR(value(m, "sim3.scale"), 3, 1e-9) << "of the estimate as it is";
  for (const char* key : {"none", "yaw", "se3"})
    EXPECT_FALSE(m.get(std::string("trajectory.") + key + ".ate_rmse_m")) << key;
  EXPECT_EQ(success_of(m), 1);
  EXPECT_EQ(score_loss(input).get("trajectory.loss.unreported_s"), 0);
}

TEST(ScoreTrajectory, AWorldOfItsOwnWithoutAPoseInTheIntervalCannotBeCompared) {
  TrajectoryScoreInput input = in_another_world({3, Rigid3()});
  input.freedom = Alignment::kSim3;
  std::vector<StampedPose> late;
  for (const StampedPose& pose : input.estimate.poses())
    late.push_back({pose.t_s + 5, pose.world_from_camera});
  input.estimate = Trajectory(late);
  const Metrics m = score_trajectory(input);
  for (const char* key : {"dt_m.mean", "dtheta_deg.mean", "lost_s", "aligned_freedoms"})
    EXPECT_FALSE(m.get(std::string("trajectory.") + key)) << key;
  EXPECT_EQ(success_of(m), 0);
}

TEST(ScoreTrajectory, OfAWorldThatIsUprightAndInMetresOnlyTheHeadingIsAligned) {
  TrajectoryScoreInput turned = in_another_world({1, Rigid3(so3_exp({0, 0, 2}), {1, 2, 3})});
  turned.freedom = Alignment::kYaw;
  const Metrics m = score_trajectory(turned);
  EXPECT_NEAR(value(m, "dt_rel_percent.max"), 0, 1e-6);
  EXPECT_EQ(value(m, "aligned_freedoms"), 4);
  EXPECT_FALSE(m.get("trajectory.none.ate_rmse_m"));
  EXPECT_NEAR(value(m, "yaw.ate_rmse_m"), 0, 1e-9);
  EXPECT_EQ(success_of(m), 1);

  // Neither a wrong vertical nor a wrong scale is forgiven.
  for (const Similarity& wrong : {Similarity{1, Rigid3(so3_exp({0.2, 0, 2}), {1, 2, 3})},
                                  Similarity{1.1, Rigid3(so3_exp({0, 0, 2}), {1, 2, 3})}}) {
    TrajectoryScoreInput input = in_another_world(wrong);
    input.freedom = Alignment::kYaw;
    EXPECT_GT(value(score_trajectory(input), "dt_rel_percent.mean"), 2);
    EXPECT_EQ(success_of(score_trajectory(input)), 0);
  }
}

}  // namespace
}  // namespace saccade
