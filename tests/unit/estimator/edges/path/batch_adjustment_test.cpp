#include "estimator/edges/path/batch_adjustment.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/process/parallel.h"
#include "estimator/depth/depth_config.h"
#include "tests/support/error_of.h"
#include "tests/support/handheld_motion.h"
#include "tests/support/planar_world.h"

namespace saccade {
namespace {

using testing::corner_glide;
using testing::corner_world;
using testing::kCornerDepth_m;

constexpr double kJointEnd_s = 0.4;
constexpr double kGivenUntil_s = 0.15;

Rigid3 drifted(double t_s) { return testing::drifting_glide(t_s, kGivenUntil_s, kJointEnd_s); }

struct JointRecording {
  testing::PlanarWorld world = corner_world(160, 120);
  Events events = world.simulate(corner_glide, 0, kJointEnd_s, 1e-3, 0.15);
};

const JointRecording& joint_recording() {
  static const JointRecording recording;
  return recording;
}

/// What a perfect sensor feels on the glide, its world's z axis pointing up; the gyroscope is
/// biased.
MountedImu readings_of_glide() {
  std::vector<StampedPose> poses;
  for (int i = 0; i <= 9; ++i) poses.push_back({0.05 * i, corner_glide(0.05 * i)});
  MountedImu imu;
  imu.samples = testing::imu_readings(Spline::interpolate(poses), Rigid3(), {0.01, -0.02, 0.03},
                                      Eigen::Vector3d::Zero());
  imu.noise = {1000, {1e-3, 0}, {1e-4, 0}};
  return imu;
}

BatchAdjustment refined(int rounds, const std::function<void(std::size_t)>& progress = {},
                        const std::optional<MountedImu>& imu = {},
                        int given_events_per_edge = 100) {
  const PinholeCamera& camera = joint_recording().world.camera();
  BatchInput start;
  for (double t_s = 0; t_s <= kJointEnd_s + 1e-9; t_s += 2e-3) {
    start.path.push_back({t_s, drifted(t_s)});
    if (t_s <= kGivenUntil_s) start.given.push_back({t_s, corner_glide(t_s)});
  }
  start.keyframe_s = {0.1, 0.2, 0.3};
  start.typical_depth_m = kCornerDepth_m;
  BatchAdjustmentOptions options;
  options.window_s = 0.3;
  options.problem.edges = 300;
  options.events_per_edge = 20;
  options.given_events_per_edge = given_events_per_edge;
  options.rounds = rounds;
  options.use_imu = imu.has_value();
  options.imu_interval_s = 0.04;
  start.imu = imu;
  const DepthConfig config;
  return adjust_batch(joint_recording().events, start, camera,
                      RayDepth(config.rays, config.limits, camera), options, progress);
}

double position_sigma_m(const BatchAdjustment& result, double t_s) {
  return std::sqrt(result.covariance_at(t_s).topLeftCorner<3, 3>().trace());
}

TEST(BatchAdjustments, CorrectsADriftingPath) {
  std::size_t steps = 0;
  const BatchAdjustment result = refined(2, [&](std::size_t n) { steps += n; });
  for (const double t_s : {0.25, 0.3, 0.35, 0.38}) {
    const Twist before = (corner_glide(t_s).inverse() * drifted(t_s)).log();
    const Twist after = (corner_glide(t_s).inverse() * result.path.at_clamped(t_s)).log();
    EXPECT_LT(after.head<3>().norm(), 0.4 * before.head<3>().norm()) << t_s;
    EXPECT_LT(after.tail<3>().norm(), 0.4 * before.tail<3>().norm()) << t_s;
  }
  const Twist at_start = (corner_glide(0.05).inverse() * result.path.at_clamped(0.05)).log();
  EXPECT_LT(at_start.head<3>().norm(), 0.001 * kCornerDepth_m);
  EXPECT_GT(result.observations, 5000U);
  EXPECT_LT(result.residual_px, 0.4);
  EXPECT_EQ(result.costs.rounds(), 2);
  EXPECT_EQ(steps, 22U) << "two rounds of ten iterations and finding the edges";
  // The start is given; what is far from it is less certain.
  EXPECT_GT(position_sigma_m(result, 0.38), 2 * position_sigma_m(result, 0.1));
}

TEST(BatchAdjustments, AnInertialSensorFindsGravityAndConstrainsThePath) {
  const BatchAdjustment without = refined(1);
  const BatchAdjustment with = refined(1, {}, readings_of_glide());
  ASSERT_TRUE(with.inertial);
  EXPECT_FALSE(without.inertial);
  EXPECT_NEAR(with.inertial->scale, 1, 1e-3) << "the start is metric";
  EXPECT_LT(std::acos(-with.inertial->gravity.normalized().z()), 0.02);
  EXPECT_LT((with.inertial->bias.gyro - Eigen::Vector3d(0.01, -0.02, 0.03)).norm(), 0.01);
  const auto error_rad = [](const BatchAdjustment& result) {
    return angle_between(corner_glide(0.38).rotation(), result.path.at_clamped(0.38).rotation());
  };
  EXPECT_LT(error_rad(with), error_rad(without));
}

TEST(BatchAdjustments, EventsOfTheStartCountBesideTheOthers) {
  const BatchAdjustment few = refined(1, {}, {}, 5), many = refined(1, {}, {}, 100);
  EXPECT_GT(many.observations, few.observations * 3 / 2);
  // They say how large everything is, and so where the path ends.
  EXPECT_LT(position_sigma_m(many, 0.38), position_sigma_m(few, 0.38));
}

/// corner_glide() there and back within kReturn_s.
constexpr double kReturn_s = 0.8;
Rigid3 there_and_back(double t_s) {
  constexpr double kPi = 3.14159265358979;
  return corner_glide(0.2 * (1 - std::cos(2 * kPi * t_s / kReturn_s)));
}

/// Drifts as evenly as a tracker does, by 1 % of the depth and 7 mrad.
Rigid3 drifted_there_and_back(double t_s) {
  const double away = std::max(0.0, t_s - kGivenUntil_s) / (kReturn_s - kGivenUntil_s);
  return there_and_back(t_s) *
         Rigid3::exp(away * (Twist() << 0.016, -0.01, 0.015, 0.003, 0.004, -0.005).finished());
}

BatchAdjustment refined_there_and_back(const Events& events, int reobserved_keyframes) {
  const PinholeCamera& camera = joint_recording().world.camera();
  BatchInput start;
  for (double t_s = 0; t_s <= kReturn_s + 1e-9; t_s += 2e-3) {
    start.path.push_back({t_s, drifted_there_and_back(t_s)});
    if (t_s <= kGivenUntil_s) start.given.push_back({t_s, there_and_back(t_s)});
  }
  for (int k = 1; k < 8; ++k) start.keyframe_s.push_back(0.1 * k);
  start.typical_depth_m = kCornerDepth_m;
  BatchAdjustmentOptions options;
  options.window_s = 0.3;
  options.problem.edges = 200;
  options.events_per_edge = 20;
  options.problem.reobserved_views = reobserved_keyframes;
  const DepthConfig config;
  return adjust_batch(events, start, camera, RayDepth(config.rays, config.limits, camera), options);
}

TEST(BatchAdjustments, ReobservationsConstrainALongPath) {
  const Events events = joint_recording().world.simulate(there_and_back, 0, kReturn_s, 1e-3, 0.15);
  const BatchAdjustment apart = refined_there_and_back(events, 0);
  const BatchAdjustment tied = refined_there_and_back(events, 4);
  EXPECT_GT(tied.observations, apart.observations * 11 / 10);
  // The end sees what the given start saw.
  const auto error_m = [](const BatchAdjustment& result) {
    return (there_and_back(0.7).inverse() * result.path.at_clamped(0.7)).translation().norm();
  };
  EXPECT_LT(error_m(tied), 0.5 * error_m(apart));
  EXPECT_LT(position_sigma_m(tied, 0.7), 0.5 * position_sigma_m(apart, 0.7));
}

TEST(BatchAdjustments, SaysThatReadingsDoNotFit) {
  MountedImu imu = readings_of_glide();
  imu.samples.resize(20);
  EXPECT_THAT(testing::error_of([&] { return refined(1, {}, imu); }),
              ::testing::StartsWith("imu.txt: the readings of imu.txt"));
}

TEST(BatchAdjustments, IsTheSameForAnyNumberOfThreads) {
  set_thread_count(1);
  const BatchAdjustment one = refined(1);
  set_thread_count(3);
  const BatchAdjustment three = refined(1);
  set_thread_count(0);
  ASSERT_EQ(one.path.size(), three.path.size());
  for (std::size_t i = 0; i < one.path.size(); ++i) {
    EXPECT_EQ(one.path.poses()[i].world_from_camera.translation(),
              three.path.poses()[i].world_from_camera.translation());
    EXPECT_EQ(one.path.poses()[i].world_from_camera.rotation().coeffs(),
              three.path.poses()[i].world_from_camera.rotation().coeffs());
  }
  EXPECT_EQ(one.covariances, three.covariances);
}

}  // namespace
}  // namespace saccade
