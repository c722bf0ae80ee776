#include "simulator/sensor/labels/optical_flow_renderer.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/unit/simulator/scene/plane_scene.h"

namespace saccade {
namespace {

const PinholeCamera kFlowCamera{61, 46, 100, 100, 30, 22.5, {}};
const PinholeCamera kLensCamera{41, 30, 60, 63, 21, 14, {-0.2, 0.05, 0.003, -0.002, 0}};
const ImageF kFlowGrey(2, 2, 0.5F);

Mesh wall(double distance) {
  return testing::rectangle({-30, -30, distance}, {60, 0, 0}, {0, 60, 0}, kFlowGrey);
}

/// Of each kind how many pixels.
std::ptrdiff_t count(const OpticalFlow& flow, Covisibility kind) {
  return std::ranges::count(flow.covisibility.pixels(), static_cast<std::uint8_t>(kind));
}

TEST(OpticalFlow, TranslationBeforeAPlane) {
  const Scene scene = testing::scene_of({wall(2)});
  const OpticalFlowRenderer renderer(scene, kFlowCamera);
  const OpticalFlowPair pair = renderer.pair({0, {}}, {1, {so3_exp({0, 0, 0}), {0.04, -0.02, 0}}});
  for (int y = 0; y < 46; ++y)
    for (int x = 0; x < 61; ++x) {
      EXPECT_NEAR(pair.forward.u(x, y), -2, 1e-5);
      EXPECT_NEAR(pair.forward.v(x, y), 1, 1e-5);
      EXPECT_NEAR(pair.backward.u(x, y), 2, 1e-5);
      EXPECT_NEAR(pair.backward.v(x, y), -1, 1e-5);
    }
  // Two columns and a row leave the image.
  EXPECT_EQ(count(pair.forward, Covisibility::kOutside), 61 * 46 - 59 * 45);
  EXPECT_EQ(count(pair.forward, Covisibility::kOccluded), 0);
}

TEST(OpticalFlow, ApproachIsRadial) {
  const Scene scene = testing::scene_of({wall(2)});
  const OpticalFlow flow =
      OpticalFlowRenderer(scene, kFlowCamera).flow({0, {}}, {1, {so3_exp({0, 0, 0}), {0, 0, 0.4}}});
  for (int y = 0; y < 46; y += 3)
    for (int x = 0; x < 61; x += 3) {
      EXPECT_NEAR(flow.u(x, y), 0.25 * (x - 30), 1e-5);
      EXPECT_NEAR(flow.v(x, y), 0.25 * (y - 22.5), 1e-5);
    }
}

TEST(OpticalFlow, RotationIsTheInfiniteHomographyOnBackgroundAndSurfaces) {
  const Scene scene =
      testing::scene_of({testing::rectangle({0, -9, 3}, {9, 0, 0}, {0, 18, 2}, kFlowGrey)});
  const Eigen::Quaterniond rotation = so3_exp({0.05, -0.08, 0.2});
  const OpticalFlow flow =
      OpticalFlowRenderer(scene, kFlowCamera).flow({0, {}}, {1, {rotation, {0, 0, 0}}});
  const Eigen::Matrix3d homography = kFlowCamera.matrix() *
                                     rotation.toRotationMatrix().transpose() *
                                     kFlowCamera.matrix().inverse();
  for (int y = 0; y < 46; ++y)
    for (int x = 0; x < 61; ++x) {
      const Eigen::Vector2d to = (homography * Eigen::Vector3d(x, y, 1)).hnormalized();
      EXPECT_NEAR(flow.u(x, y), to.x() - x, 1e-4);
      EXPECT_NEAR(flow.v(x, y), to.y() - y, 1e-4);
      EXPECT_EQ(flow.is_valid(x, y), 1);
    }
  EXPECT_EQ(count(flow, Covisibility::kOccluded), 0);
  EXPECT_GT(count(flow, Covisibility::kOutside), 0);
}

TEST(OpticalFlow, APlaneThatMovesBeforeALensThatMoves) {
  const Eigen::Vector3d corner(-30, -30, 2), right(60, 0, 3), down(0, 60, 5);
  const Rigid3 object(so3_exp({-0.05, 0.05, 0.1}), {0.1, 0, 0.2});
  SceneBuilder builder;
  builder.add_moving(testing::rectangle(corner, right, down, kFlowGrey),
                     Eigen::Affine3d::Identity(),
                     Spline::interpolate(std::vector<StampedPose>{{0, Rigid3()}, {1, object}}));
  const Scene scene = std::move(builder).build(Background(0.5));
  const Rigid3 camera(so3_exp({0.02, -0.03, 0.05}), {0.1, -0.05, 0.1});
  const OpticalFlow flow = OpticalFlowRenderer(scene, kLensCamera).flow({0, {}}, {1, camera});
  const Eigen::Vector3d normal = right.cross(down);
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 41; ++x) {
      const Eigen::Vector3d ray = kLensCamera.ray(kLensCamera.undistort({x, y}));
      const Eigen::Vector3d point = normal.dot(corner) / normal.dot(ray) * ray;
      const Eigen::Vector2d to =
          kLensCamera.distort(kLensCamera.project(camera.inverse() * (object * point)));
      EXPECT_NEAR(flow.u(x, y), to.x() - x, 1e-4);
      EXPECT_NEAR(flow.v(x, y), to.y() - y, 1e-4);
    }
  EXPECT_EQ(count(flow, Covisibility::kOccluded), 0);
}

TEST(OpticalFlow, WhatARectangleCoversNextIsOccluded) {
  // The rectangle is on columns 25 to 35 and rows 20 to 25; it moves by two pixels, the wall by one.
  const Scene scene = testing::scene_of(
      {wall(4), testing::rectangle({-0.105, -0.055, 2}, {0.21, 0, 0}, {0, 0.11, 0}, kFlowGrey)});
  const OpticalFlow flow = OpticalFlowRenderer(scene, kFlowCamera)
                               .flow({0, {}}, {1, {so3_exp({0, 0, 0}), {0.04, 0, 0}}});
  for (int y = 0; y < 46; ++y)
    for (int x = 0; x < 61; ++x) {
      const bool is_rectangle = x >= 25 && x <= 35 && y >= 20 && y <= 25;
      EXPECT_NEAR(flow.u(x, y), is_rectangle ? -2 : -1, 1e-5);
      const Covisibility expected = x == 0                          ? Covisibility::kOutside
                                    : x == 24 && y >= 20 && y <= 25 ? Covisibility::kOccluded
                                                                    : Covisibility::kVisible;
      EXPECT_EQ(flow.covisibility(x, y), static_cast<std::uint8_t>(expected)) << x << " " << y;
    }
}

TEST(OpticalFlow, BackgroundIsOccludedBySurfacesAndWhatIsBehindIsNotValid) {
  const Scene scene = testing::scene_of(
      {testing::rectangle({-0.105, -0.055, 2}, {0.21, 0, 0}, {0, 0.11, 0}, kFlowGrey)});
  const OpticalFlowRenderer renderer(scene, kFlowCamera);
  const OpticalFlow flow = renderer.flow({0, {}}, {1, {so3_exp({0, 0, 0}), {0.04, 0, 0}}});
  EXPECT_EQ(count(flow, Covisibility::kOccluded), 2 * 6);
  EXPECT_EQ(flow.u(23, 22), 0);
  EXPECT_EQ(flow.covisibility(23, 22), 255);
  const OpticalFlow around = renderer.flow({0, {}}, {1, {so3_exp({0, 3.1, 0}), {0, 0, 0}}});
  EXPECT_EQ(std::ranges::count(around.is_valid.pixels(), 1), 0);
  EXPECT_EQ(count(around, Covisibility::kOutside), 61 * 46);
}

TEST(OpticalFlow, BackAndForthEndsWhereItBeganOnACurvedSurface) {
  const Scene scene = testing::scene_of({testing::ball({0, 0, 3}, 0.5, 40, kFlowGrey), wall(6)});
  const OpticalFlowRenderer renderer(scene, kFlowCamera);
  const OpticalFlowPair pair =
      renderer.pair({0, {}}, {1, {so3_exp({0.01, 0.02, 0.03}), {0.1, -0.05, 0.05}}});
  int compared = 0;
  for (int y = 0; y < 46; ++y)
    for (int x = 0; x < 61; ++x) {
      if (pair.forward.covisibility(x, y) != 0) continue;
      const double to_x = static_cast<double>(x) + static_cast<double>(pair.forward.u(x, y));
      const double to_y = static_cast<double>(y) + static_cast<double>(pair.forward.v(x, y));
      if (!is_inside(pair.backward.u, to_x, to_y)) continue;
      const double back = sample(pair.backward.u, to_x, to_y);
      // Next to the outline of the ball the four pixels are not of one surface.
      const Eigen::Vector2d from_centre(x - 30, y - 22.5);
      if (std::abs(from_centre.norm() - 17) < 6) continue;
      EXPECT_NEAR(back, -static_cast<double>(pair.forward.u(x, y)), 0.05);
      ++compared;
    }
  EXPECT_GT(compared, 1000);
  EXPECT_GT(count(pair.forward, Covisibility::kOccluded), 10);
}

}  // namespace
}  // namespace saccade
