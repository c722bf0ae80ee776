#include "estimator/odometry/start/first_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "estimator/odometry/start/carried_path.h"
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
  options.adjustment.known_sigma_px = 0.02;
  options.depth.method = DepthConfig::Method::kRays;
  options.depth.rays.refiner.max_sigma = 0.03;
  options.depth.rays.fusion.min_neighbours = 1;
  options.depth.rays.fusion.max_sigma = 0.05;
  return options;
}

KnownPath given() {
  KnownPath path;
  path.poses = testing::trajectory_of(shaken, kGiven_s);
  path.settled_until_s = path.given_until_s = kGiven_s;
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

FirstMap made(const KnownPath& start, const FirstMapOptions& options) {
  return first_map(events(), start, Mapper(quick_mapping(), corner().camera()), corner().camera(),
                   options, {});
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
  const Trajectory blind = carried_on(given().poses, first.path.poses.end_s(), {});
  EXPECT_GT(worst_of(blind, kGiven_s, kWhole_s).rad, 3 * found.rad) << "the events say more";
}

TEST(FirstMap, IsDeterministic) {
  const FirstMap one = made(given(), carried());
  const FirstMap two = made(given(), carried());
  ASSERT_EQ(one.path.poses.size(), two.path.poses.size());
  EXPECT_EQ(one.path.poses.poses().back().world_from_camera.translation(),
            two.path.poses.poses().back().world_from_camera.translation());
}

TEST(FirstMap, EndsWithTheLongestPathThatIsAllowed) {
  FirstMapOptions options = carried();
  options.min_edges = 1000000;
  options.window_s = 0.12;
  EXPECT_LT(made(given(), options).path.poses.end_s(), 0.1221);
}

TEST(FirstMap, AStartThatWasFoundIsTakenAsItIs) {
  KnownPath start = given();
  start.given_until_s = kNothingGiven;
  start.settled_until_s = 0;
  EXPECT_DOUBLE_EQ(made(start, carried()).path.poses.end_s(), kGiven_s);
}

}  // namespace
}  // namespace saccade
