#include "estimator/reconstruction/surface/point_surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <vector>

namespace saccade {
namespace {

/// Appends points at `depth` on every `step`-th pixel from `first` to `last`.
template <class Depth>
void append_points(std::vector<SurfacePoint>& points, const PinholeCamera& camera,
                   Eigen::Vector2i first, Eigen::Vector2i last, int step, const Depth& depth) {
  for (int y = first.y(); y <= last.y(); y += step)
    for (int x = first.x(); x <= last.x(); x += step)
      points.push_back({depth(x, y) * camera.ray({x, y}), 0.005});
}

const PinholeCamera kSurfaceCamera{96, 72, 80, 80, 47.5, 35.5, {}};

TEST(PointSurface, NearSurfacesEndWhereTheirPointsDo) {
  const PinholeCamera& camera = kSurfaceCamera;
  std::vector<SurfacePoint> points;
  append_points(points, camera, {30, 20}, {60, 50}, 3, [](int, int) { return 1.0; });
  append_points(points, camera, {0, 0}, {18, 71}, 3, [](int, int) { return 3.0; });
  append_points(points, camera, {75, 0}, {95, 71}, 3, [](int, int) { return 3.0; });
  const ImageF depth = surface_through(points, camera);
  EXPECT_NEAR(depth(45, 35), 1, 0.01);
  EXPECT_NEAR(depth(31, 48), 1, 0.01);
  for (const int x : {5, 22, 27, 64, 70, 90}) EXPECT_NEAR(depth(x, 35), 3, 0.03) << x;
  for (const int y : {5, 15, 55, 66}) EXPECT_NEAR(depth(45, y), 3, 0.03) << y;
}

// Planes equal to the current ones leave the moves without a pair to cut.
TEST(PointSurface, PointsOfOnePlaneGiveThePlane) {
  std::vector<SurfacePoint> points;
  for (int y = 4; y < kSurfaceCamera.height; y += 8)
    for (int x = 4; x < kSurfaceCamera.width; x += 8)
      points.push_back({2.0 * kSurfaceCamera.ray({x, y}), 0.002});
  const ImageF depth = surface_through(points, kSurfaceCamera);
  for (const float z : depth.pixels()) EXPECT_NEAR(z, 2, 0.01);
}

TEST(PointSurface, IgnoresOccludedPointsAndOutliers) {
  const PinholeCamera& camera = kSurfaceCamera;
  std::vector<SurfacePoint> points;
  append_points(points, camera, {0, 0}, {95, 71}, 3, [](int, int) { return 1.0; });
  append_points(points, camera, {31, 31}, {61, 61}, 6, [](int, int) { return 2.5; });
  points[100].position *= 0.7;
  const ImageF depth = surface_through(points, camera);
  int wrong = 0;
  for (const float z : depth.pixels()) wrong += std::abs(z - 1) > 0.01F ? 1 : 0;
  EXPECT_LE(wrong, 1);
}

TEST(PointSurface, SlantedPlanesMeetAtTheirCrease) {
  const PinholeCamera& camera = kSurfaceCamera;
  // 1 / z of two planes that meet at column 40.
  const auto depth_of = [](int x, int) { return 1 / (0.5 + 0.004 * std::abs(x - 40)); };
  std::vector<SurfacePoint> points;
  append_points(points, camera, {2, 2}, {94, 70}, 2, depth_of);
  const ImageF depth = surface_through(points, camera);
  for (int y = 0; y < 72; ++y)
    for (int x = 0; x < 96; ++x) {
      const double error = std::abs(static_cast<double>(depth(x, y)) / depth_of(x, y) - 1);
      EXPECT_LT(error, std::abs(x - 40) < 4 ? 0.03 : 0.005) << x << " " << y;
    }
}

/// A slanted wall behind a card, on a view of odd size.
TEST(PointSurface, IsNearlyTheSameByCoarseSquares) {
  const PinholeCamera camera{97, 71, 80, 80, 48.2, 35.1, {}};
  const auto wall = [](int x, int) { return 1 / (0.3 + 0.001 * x); };
  std::vector<SurfacePoint> points;
  append_points(points, camera, {30, 20}, {60, 50}, 2, [](int, int) { return 1.0; });
  append_points(points, camera, {0, 0}, {24, 70}, 2, wall);
  append_points(points, camera, {66, 0}, {96, 70}, 2, wall);
  const ImageF fine = surface_through(points, camera);
  const ImageF coarse = coarse_surface_through(points, camera);
  ASSERT_EQ(coarse.width(), 97);
  ASSERT_EQ(coarse.height(), 71);
  int differing = 0;
  for (std::size_t i = 0; i < fine.size(); ++i)
    differing += std::abs(coarse.pixels()[i] / fine.pixels()[i] - 1) > 0.01F ? 1 : 0;
  EXPECT_LT(differing, 0.05 * static_cast<double>(fine.size()));
  // Where surfaces do not end planes are planes.
  for (const int x : {0, 7, 12, 85, 96})
    for (const int y : {0, 33, 70})
      EXPECT_NEAR(coarse(x, y) / wall(x, y), 1, 0.005) << x << " " << y;
  for (const int x : {36, 45, 54}) EXPECT_NEAR(coarse(x, 35), 1, 0.005) << x;
}

TEST(PointSurface, WithoutPointsNothingIsKnown) {
  for (const ImageF& depth :
       {surface_through({}, kSurfaceCamera), coarse_surface_through({}, kSurfaceCamera)})
    for (const float z : depth.pixels()) EXPECT_EQ(z, 0);
}

}  // namespace
}  // namespace saccade
