#include "estimator/odometry/mapper.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <optional>
#include <span>

#include "estimator/odometry/view_turn.h"
#include "tests/support/planar_world.h"

namespace saccade {
namespace {

constexpr double kMapped_s = 0.12;

/// Edges of a map of a tenth of a second, of whose depths hardly any is so certain.
std::size_t edges_with(int min_edges) {
  static const testing::PlanarWorld corner = testing::corner_world(160, 120);
  static const Events events = corner.simulate(testing::corner_glide, 0, kMapped_s, 1e-3, 0.15);
  MappingOptions options;
  options.image = false;
  options.min_edges = min_edges;
  options.depth.method = DepthConfig::Method::kRays;
  options.max_sigma = 0.01;
  options.depth.rays.refiner.max_sigma = options.depth.rays.fusion.max_sigma = 0.004;
  PathEstimate path;
  path.poses = testing::trajectory_of(testing::corner_glide, kMapped_s);
  return Mapper(options, corner.camera()).map(events, path).keyframe.edges.size();
}

TEST(Mapper, WhereFewEdgesAreCertainOthersWillDo) {
  const std::size_t certain = edges_with(0);
  ASSERT_GT(certain, 10U);
  const std::size_t some = edges_with(1);
  EXPECT_GT(some, certain + certain / 4) << "however many there are elsewhere";
  EXPECT_EQ(edges_with(1000000), some) << "no depth is typical that others could be assumed at";
}

/// A turn to the side that moves the image by some 25 px in kMapped_s, from one place.
Rigid3 turn(double t_s) {
  return {Rigid3::exp((Twist() << 0, 0, 0, 0.3 * t_s, 1.6 * t_s, 0).finished()).rotation(),
          {0, 0, 0}};
}

/// Of the events after `from_s` whose edge is in the map's view, the fraction within a pixel of a
/// point of the map.
double fraction_on_map(std::span<const Event> events, double from_s, const MapPoints& map,
                       const PinholeCamera& camera) {
  std::size_t near = 0, all = 0;
  for (std::size_t i = 0; i < events.size(); i += 20) {
    const double t_s = seconds_from_ns(events[i].t_ns);
    if (t_s < from_s) continue;
    ++all;
    const Rigid3 camera_from_world = turn(t_s).inverse();
    for (std::size_t k = 0; k < map.size(); ++k) {
      const Eigen::Vector3d point =
          camera_from_world * Eigen::Vector3d(map.x[k], map.y[k], map.z[k]);
      if (point.z() <= 0) continue;
      if ((camera.project(point) - Eigen::Vector2d(events[i].x, events[i].y)).norm() > 1) continue;
      ++near;
      break;
    }
  }
  return static_cast<double>(near) / static_cast<double>(all);
}

const testing::PlanarWorld& turned_world() {
  static const testing::PlanarWorld corner = testing::corner_world(160, 120);
  return corner;
}

const Events& events_of_turn() {
  static const Events events = turned_world().simulate(turn, 0, kMapped_s, 1e-3, 0.15);
  return events;
}

/// The keyframe of a turn on its true path, which shows no depth.
Keyframe keyframe_of_turn(int adjust_rounds, std::optional<double> typical_depth_m) {
  MappingOptions options;
  options.image = false;
  options.min_edges = 300;
  options.adjust_rounds = adjust_rounds;
  options.depth.method = DepthConfig::Method::kRays;
  options.depth.rays.refiner.max_sigma = 0.015;  // nine times as much where few edges are found
  options.depth.rays.fusion.max_sigma = 0.02;
  PathEstimate path;
  path.poses = testing::trajectory_of(turn, kMapped_s);
  path.fixed_until_s = kMapped_s;
  path.typical_depth_m = typical_depth_m;
  return Mapper(options, turned_world().camera()).map(events_of_turn(), path).keyframe;
}

TEST(Mapper, ATurningCameraMapsEdgesAtTheTypicalDepth) {
  for (const int adjust_rounds : {0, 1}) {
    const Keyframe keyframe = keyframe_of_turn(adjust_rounds, testing::kCornerDepth_m);
    EXPECT_GT(keyframe.edges.size(), 300U);
    EXPECT_TRUE(keyframe.depth.points.empty()) << "an assumed depth is no measured one";
    const Rigid3 view_from_world = keyframe.world_from_camera.inverse();
    for (std::size_t i = 0; i < keyframe.edges.size(); ++i) {
      const Eigen::Vector3d point =
          view_from_world *
          Eigen::Vector3d(keyframe.edges.x[i], keyframe.edges.y[i], keyframe.edges.z[i]);
      ASSERT_NEAR(point.z(), testing::kCornerDepth_m, 0.01 * testing::kCornerDepth_m);
    }
    // The view is at the end: most of what was seen shortly before is in it.
    EXPECT_GT(fraction_on_map(events_of_turn(), 0.75 * kMapped_s, keyframe.edges,
                              turned_world().camera()),
              0.5);
  }
}

TEST(Mapper, WhatTurnsOutOfViewIsNotMapped) {
  MappingOptions options;
  options.events = 10000000;
  options.image = false;
  options.depth.method = DepthConfig::Method::kRays;
  PathEstimate path;
  path.poses = testing::trajectory_of(turn, kMapped_s);
  const auto first_s = [&](double most_turn) {
    options.turn = most_turn;
    return Mapper(options, turned_world().camera()).map(events_of_turn(), path).keyframe.start_s;
  };
  EXPECT_LT(first_s(0), 0.01) << "all of it";
  EXPECT_LT(first_s(1), 0.01) << "a whole view is not gone";
  // It turns by 1.63 rad/s, and sees 0.85 rad.
  const double angle = angle_of_view(turned_world().camera());
  EXPECT_NEAR(first_s(0.1), kMapped_s - 0.1 * angle / 1.63, 0.003);
}

TEST(Mapper, EdgesOfUnknownDepthsHaveOneInCommon) {
  // Beside the turn, less than three pixels of parallax at the middle of the corner.
  const auto motion = [](double t_s) { return Rigid3(turn(t_s).rotation(), {0.35 * t_s, 0, 0}); };
  const Events events = turned_world().simulate(motion, 0, kMapped_s, 1e-3, 0.15);
  MappingOptions options;
  options.image = false;
  options.depth.method = DepthConfig::Method::kRays;
  const Mapper mapper(options, turned_world().camera());
  PathEstimate path;
  path.poses = testing::trajectory_of(motion, kMapped_s);
  path.fixed_until_s = path.given_until_s = kMapped_s;
  for (double depth_m : {0.5, 2.0, 4.0}) {
    for (int i = 0; i < 6; ++i) depth_m = mapper.common_depth(events, path, depth_m).value();
    EXPECT_NEAR(depth_m, testing::kCornerDepth_m, 0.25 * testing::kCornerDepth_m);
  }
  EXPECT_FALSE(mapper.common_depth({}, path, 3));
  path.poses = testing::trajectory_of(turn, kMapped_s);
  for (const double depth_m : {0.5, 2.0, 4.0})
    EXPECT_NEAR(mapper.common_depth(events_of_turn(), path, depth_m).value_or(depth_m), depth_m,
                0.05 * depth_m)
        << "a turn tells no depth";
}

TEST(Mapper, NoDepthIsAssumedWhereNoneIsTypical) {
  for (const int adjust_rounds : {0, 1})
    EXPECT_EQ(keyframe_of_turn(adjust_rounds, std::nullopt).edges.size(), 0U);
}

}  // namespace
}  // namespace saccade
