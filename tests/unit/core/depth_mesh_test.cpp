#include "core/depth_mesh.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/planar_world.h"

namespace saccade {
namespace {

using testing::corner_motion;
using testing::corner_world;

/// Share of the pixels whose depth is within `tolerance` of the truth, of those that are known.
double agreeing(const ImageF& inverse_depth, const ImageF& truth, double tolerance) {
  double good = 0, known = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (!(truth.pixels()[i] > 0) || !(inverse_depth.pixels()[i] > 0)) continue;
    const double ratio = static_cast<double>(inverse_depth.pixels()[i] * truth.pixels()[i]);
    good += std::abs(ratio - 1) < tolerance ? 1 : 0;
    ++known;
  }
  EXPECT_GT(known, 0.8 * static_cast<double>(truth.size()));
  return good / known;
}

TEST(DepthMesh, SeesWhatTheWorldShowsFromElsewhere) {
  const auto world = corner_world(120, 90);
  const DepthMesh mesh(world.depth(corner_motion(0)), world.camera());
  ImageF inverse(120, 90);
  mesh.draw(corner_motion(0.1).inverse() * corner_motion(0), world.camera(), inverse);
  EXPECT_GT(agreeing(inverse, world.depth(corner_motion(0.1)), 1e-3), 0.97);
}

TEST(DepthMesh, DoesNotJoinWhatADepthStepParts) {
  const PinholeCamera camera{40, 30, 40, 40, 19.5, 14.5, {}};
  ImageF depth(40, 30, 2);
  for (int y = 0; y < 30; ++y)
    for (int x = 20; x < 40; ++x) depth(x, y) = 1;
  const DepthMesh mesh(depth, camera);
  EXPECT_NEAR(mesh.typical_depth_m(), 4 / 3.0, 1e-6);
  ImageF inverse(40, 30);
  // From the left the near half moves by 4 px and the far one by 2: a gap of 3 pixels opens.
  mesh.draw(Rigid3(Eigen::Quaterniond::Identity(), {0.1, 0, 0}), camera, inverse);
  EXPECT_NEAR(inverse(21, 15), 0.5, 1e-6);
  for (const int x : {22, 23}) EXPECT_EQ(inverse(x, 15), 0) << x;
  EXPECT_NEAR(inverse(25, 15), 1, 1e-6);
}

TEST(DepthMesh, WhatIsUnknownOrBehindIsNotDrawn) {
  const PinholeCamera camera{8, 6, 8, 8, 3.5, 2.5, {}};
  ImageF depth(8, 6, 1);
  depth(3, 3) = 0;
  depth(5, 3) = std::nanf("");
  const DepthMesh mesh(depth, camera);
  const auto vertices = mesh.project({}, camera);
  ASSERT_EQ(vertices.size(), depth.size());
  EXPECT_EQ(vertices[3 * 8 + 3].inverse_depth, 0);
  EXPECT_EQ(vertices[3 * 8 + 5].inverse_depth, 0);
  EXPECT_NEAR(vertices[3 * 8 + 4].x, 4, 1e-5);
  ImageF inverse(8, 6, 7);
  mesh.draw(Rigid3(Eigen::Quaterniond::Identity(), {0, 0, -2}), camera, inverse);
  for (const float value : inverse.pixels()) EXPECT_EQ(value, 0);
}

}  // namespace
}  // namespace saccade
