#include "estimator/odometry/start/first_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "core/imu_sample.h"
#include "core/process/parallel.h"
#include "estimator/odometry/start/extrapolated_path.h"
#include "tests/support/planar_world.h"

namespace saccade {
namespace {

constexpr double kWhole_s = 0.3;
constexpr double kGiven_s = 0.1;

/// To and fro by a few pixels of parallax, shaken by 0.06 rad.
Rigid3 shaken(double t_s) {
  return {so3_exp(std::sin(16 * t_s) * Eigen::Vector3d(0.01, -0.06, 0.03)),
          {0.1 * (1 - std::cos(14 * t_s)), 0.2 * t_s, 0.1 * t_s}};
}

const testing::PlanarWorld& corner() {
  static const testing::PlanarWorld corner = testing::corner_world(160, 120);
  return corner;
}

const Events& events() {
  static const Events events = corner().simulate(shaken, 0, kWhole_s, 1e-3, 0.15);
  return events;
}

MappingOptions quick_mapping() {
  MappingOptions options;
  options.view = MappingOptions::View::kMiddle;
  options.image = false;
  options.adjust_rounds = 1;
  options.adjustment.node_spacing_s = 0.02;
  options.adjustment.edges = 400;
  options.adjustment.fixed_sigma_px = 0.02;
  options.depth.method = DepthConfig::Method::kRays;
  options.depth.rays.refiner.max_sigma = 0.03;
  options.depth.rays.fusion.min_neighbours = 1;
  options.depth.rays.fusion.max_sigma = 0.05;
  return options;
}

PathEstimate given(const testing::Motion& motion = shaken) {
  PathEstimate path;
  path.poses = testing::trajectory_of(motion, kGiven_s);
  path.fixed_until_s = path.given_until_s = kGiven_s;
  return path;
}

struct Worst {
  double m = 0, rad = 0;
};

/// Errors of the poses at times within.
Worst worst_of(const Trajectory& path, double from_s, double to_s) {
  Worst worst;
  for (const StampedPose& pose : path.poses()) {
    if (pose.t_s < from_s || pose.t_s > to_s) continue;
    const Rigid3 error = shaken(pose.t_s).inverse() * pose.world_from_camera;
    worst.m = std::max(worst.m, error.translation().norm());
    worst.rad = std::max(worst.rad, so3_log(error.rotation()).norm());
  }
  return worst;
}

FirstMap made(const PathEstimate& start, const FirstMapOptions& options,
              const Gyroscope& gyroscope = {}) {
  return first_map(events(), start, Mapper(quick_mapping(), corner().camera()), corner().camera(),
                   options, gyroscope);
}

FirstMapOptions carried() {
  FirstMapOptions options;
  options.min_edges = 400;
  options.window_s = 0.2;
  return options;
}

TEST(FirstMap, GivenPosesThatShowTooLittleAreCarriedOn) {
  const FirstMap little = made(given(), {});
  EXPECT_DOUBLE_EQ(little.path.poses.end_s(), kGiven_s) << "unless it is asked for";
  const FirstMap first = made(given(), carried());
  ASSERT_LT(little.mapping.keyframe.edges.size(), carried().min_edges);
  EXPECT_GE(first.mapping.keyframe.edges.size(), carried().min_edges);
  EXPECT_EQ(first.path.given_until_s, kGiven_s);
  ASSERT_GT(first.path.poses.end_s(), kGiven_s + 0.02);
  EXPECT_LT(worst_of(first.path.poses, 0, kGiven_s).m, 1e-9) << "given poses stay as they are";
  // In metres: what was given says how far away the edges are.
  const Worst found = worst_of(first.path.poses, kGiven_s, kWhole_s);
  EXPECT_LT(found.m, 0.008 * testing::kCornerDepth_m);
  EXPECT_LT(found.rad, 0.008);
  const Trajectory blind = extrapolated(given().poses, first.path.poses.end_s(), {});
  EXPECT_GT(worst_of(blind, kGiven_s, kWhole_s).rad, 3 * found.rad) << "the events say more";
}

TEST(FirstMap, ACameraThatOnlySlidesIsNotTurned) {
  // On a slider, faster and faster: more than the acceleration of what is given tells.
  const testing::Motion slide = [](double t_s) {
    return Rigid3(so3_exp(Eigen::Vector3d::Zero()), {1.5 * t_s * t_s + 15 * t_s * t_s * t_s, 0, 0});
  };
  const Events slid = corner().simulate(slide, 0, kWhole_s, 1e-3, 0.15);
  FirstMapOptions options = carried();
  options.min_edges = 1000000;
  const FirstMap first = first_map(slid, given(slide), Mapper(quick_mapping(), corner().camera()),
                                   corner().camera(), options, {});
  const double end_s = first.path.poses.end_s();
  ASSERT_GT(end_s, kGiven_s + 0.05);
  // In equal parts the rest would turn it by 0.013 rad.
  const Rigid3 error = slide(end_s).inverse() * first.path.poses.at_clamped(end_s);
  EXPECT_LT(so3_log(error.rotation()).norm(), 0.001);
  EXPECT_LT(error.translation().norm(), 0.03 * testing::kCornerDepth_m);
}

TEST(FirstMap, IsTheSameForAnyNumberOfThreads) {
  set_thread_count(1);
  const FirstMap one = made(given(), carried());
  set_thread_count(3);
  const FirstMap three = made(given(), carried());
  set_thread_count(0);
  ASSERT_EQ(one.path.poses.size(), three.path.poses.size());
  for (std::size_t i = 0; i < one.path.poses.size(); ++i)
    EXPECT_EQ(one.path.poses.poses()[i].world_from_camera.translation(),
              three.path.poses.poses()[i].world_from_camera.translation());
  EXPECT_EQ(one.mapping.keyframe.edges.x, three.mapping.keyframe.edges.x);
}

TEST(FirstMap, AGyroscopeTellsTheTurnBeyond) {
  std::vector<ImuSample> readings;
  for (int i = 0; i * 1e-3 < kWhole_s; ++i) {
    ImuSample reading;
    reading.t_ns = ns_from_seconds(i * 1e-3);
    const Rigid3 step = shaken(i * 1e-3 - 1e-4).inverse() * shaken(i * 1e-3 + 1e-4);
    reading.angular_velocity = so3_log(step.rotation()) / 2e-4;
    readings.push_back(reading);
  }
  const Gyroscope gyroscope(readings, Eigen::Matrix3d::Identity(), Eigen::Vector3d::Zero());
  const FirstMap felt = made(given(), carried(), gyroscope);
  ASSERT_GT(felt.path.poses.end_s(), kGiven_s + 0.01);
  EXPECT_LT(worst_of(felt.path.poses, kGiven_s, kWhole_s).rad, 1e-3);
}

TEST(FirstMap, ARotationIsMappedAtAnAssumedDepth) {
  const testing::Motion turn = [](double t_s) {
    return Rigid3(so3_exp(t_s * Eigen::Vector3d(0.4, -1.2, 0.3)), {1e-4 * t_s, 0, 0});
  };
  const Events turned = corner().simulate(turn, 0, kWhole_s, 1e-3, 0.15);
  MappingOptions mapping = quick_mapping();
  mapping.min_edges = 400;
  const Mapper mapper(mapping, corner().camera());
  const FirstMap first = first_map(turned, given(turn), mapper, corner().camera(), carried(), {});
  EXPECT_GE(first.mapping.keyframe.edges.size(), Mapper::kMinEdges);
  EXPECT_TRUE(first.is_scale_guessed());
  EXPECT_NEAR(first.path.typical_depth_m.value(), std::sqrt(0.3 * 50), 1e-9)
      << "a rotation does not say otherwise";
  EXPECT_DOUBLE_EQ(first.path.poses.end_s(), kGiven_s) << "the given poses show edges enough";
  EXPECT_FALSE(made(given(), carried()).is_scale_guessed()) << "a slide tells depths";
}

TEST(FirstMap, EndsWithTheLongestPathThatIsAllowed) {
  FirstMapOptions options = carried();
  options.min_edges = 1000000;
  options.window_s = 0.12;
  const double end_s = made(given(), options).path.poses.end_s();
  EXPECT_GT(end_s, kGiven_s + 0.01);
  EXPECT_LT(end_s, 0.1211);
}

TEST(FirstMap, AGapInTheEventsIsGoneBeyond) {
  // One event, then none until long after the given poses.
  Events sparse = {events().front()};
  for (const Event& event : events())
    if (event.t_ns > ns_from_seconds(0.2)) sparse.push_back(event);
  PathEstimate start = given();
  std::vector<StampedPose> late(start.poses.poses().begin() + 10, start.poses.poses().end());
  start.poses = Trajectory(std::move(late));
  const FirstMap first = first_map(sparse, start, Mapper(quick_mapping(), corner().camera()),
                                   corner().camera(), carried(), {});
  EXPECT_GE(first.path.poses.end_s(), kGiven_s);
}

TEST(FirstMap, AStartThatWasFoundIsTakenAsItIs) {
  PathEstimate start = given();
  start.given_until_s = kNoGivenPoses;
  start.fixed_until_s = 0;
  EXPECT_DOUBLE_EQ(made(start, carried()).path.poses.end_s(), kGiven_s);
}

}  // namespace
}  // namespace saccade
