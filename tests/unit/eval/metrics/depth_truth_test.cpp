#include "eval/metrics/depth_truth.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/command.h"
#include "tests/support/fake_run.h"
#include "tests/support/planar_world.h"

namespace saccade {
namespace {

using testing::corner_motion;
using testing::corner_world;

/// Share of the pixels known in both whose relative difference is above `tolerance`.
double share_off(const ImageF& a, const ImageF& b, double tolerance) {
  double off = 0, known = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double x = static_cast<double>(a.pixels()[i]);
    const double y = static_cast<double>(b.pixels()[i]);
    if (!(x > 0) || !(y > 0)) continue;
    ++known;
    if (std::abs(x - y) > tolerance * y) ++off;
  }
  EXPECT_GT(known, 0.8 * static_cast<double>(a.size()));
  return off / known;
}

TEST(WarpDepth, ToTheSamePlaceChangesNothing) {
  const auto world = corner_world(120, 90);
  const ImageF depth = world.depth(corner_motion(0));
  const ImageF warped = warp_depth(depth, world.camera(), {});
  for (std::size_t i = 0; i < depth.size(); ++i)
    EXPECT_NEAR(warped.pixels()[i], depth.pixels()[i], 1e-5);
}

TEST(WarpDepth, IsExactOnPlanesFromElsewhere) {
  const auto world = corner_world(120, 90);
  const Rigid3 from = corner_motion(0), to = corner_motion(0.04);
  const ImageF warped = warp_depth(world.depth(from), world.camera(), to.inverse() * from);
  const ImageF truth = world.depth(to);
  // All but the rims, where a pixel's centre may fall on either side.
  EXPECT_LT(share_off(warped, truth, 1e-5), 0.03);
}

TEST(WarpDepth, WhatIsNearHidesWhatIsFar) {
  PinholeCamera camera;
  camera.width = camera.height = 40;
  camera.fx = camera.fy = 40;
  camera.cx = camera.cy = 19.5;
  // A strip at 1 m in front of a wall at 4 m, seen from 0.25 m to the left.
  ImageF depth(40, 40, 4);
  for (int y = 0; y < 40; ++y)
    for (int x = 20; x < 26; ++x) depth(x, y) = 1;
  const Rigid3 target_from_source(Eigen::Quaterniond::Identity(), {0.25, 0, 0});
  const ImageF warped = warp_depth(depth, camera, target_from_source);
  // The strip moves by 10 px, the wall by 2.5: column 32 is the strip, 24 was hidden before.
  EXPECT_FLOAT_EQ(warped(32, 20), 1);
  EXPECT_FLOAT_EQ(warped(10, 20), 4);
  EXPECT_EQ(warped(25, 20), 0) << "no map has seen what was behind the strip";
}

TEST(DepthTruth, BetweenTwoMapsIsThatOfTheWorld) {
  const testing::TemporaryFolder folder;
  testing::write_corner_dataset(folder.path() / "corner", "corner", 0.2, 120);
  const Dataset dataset = Dataset::open(folder.path() / "corner");
  const auto world = corner_world(120, 90);
  for (const double t_s : {0.0, 1 / 24.0, 0.06, 0.1}) {
    const auto truth = depth_truth_at(dataset, t_s);
    ASSERT_TRUE(truth);
    EXPECT_LT(share_off(truth->depth, world.depth(corner_motion(t_s)), 1e-4), 0.03) << t_s;
    EXPECT_TRUE(truth->has_edges);
    const auto edges = std::count(truth->edges.pixels().begin(), truth->edges.pixels().end(), 1);
    EXPECT_GT(edges, 300);
    EXPECT_LT(edges, 120 * 90 * 3 / 4);
  }
  EXPECT_EQ(depth_truth_at(dataset, 5), std::nullopt) << "nobody knows the pose";
}

TEST(DepthTruth, NeedsMaps) {
  const testing::TemporaryFolder folder;
  testing::write_corner_dataset(folder.path() / "corner", "corner", 0.1, 80);
  std::filesystem::remove(folder.path() / "corner" / "depth.txt");
  EXPECT_FALSE(depth_truth_at(Dataset::open(folder.path() / "corner"), 0.05));
}

}  // namespace
}  // namespace saccade
