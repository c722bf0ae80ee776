#include "estimator/odometry/start/tile_flow.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Eigenvalues>

#include "tests/support/planar_world.h"

namespace saccade {
namespace {

const Eigen::Vector3d kTileRate(0.1, -0.25, 0.3);
const Eigen::Vector3d kTileVelocity(1.2, 0.3, 0.1);
constexpr double kTileEnd_s = 0.1;

/// At constant velocity and rate through the identity in the middle of the window.
Rigid3 steady_glide(double t_s) {
  const double t = t_s - kTileEnd_s / 2;
  return {so3_exp(t * kTileRate), t * kTileVelocity};
}

std::vector<TileFlow> flows_from(const Events& events, const PlaneMotion& rough,
                                 const PinholeCamera& camera) {
  BurstFilter filter(camera, {.gap = 0.15, .longest = 1}, 100000);
  return tile_flows(events, filter, camera, rough);
}

TEST(TileFlow, IsThatOfTheWorldInEveryTile) {
  const testing::PlanarWorld world = testing::corner_world(240, 180);
  const Events events = world.simulate(steady_glide, 0, kTileEnd_s, 1e-3, 0.15);
  PlaneMotion rough;
  rough.rate = kTileRate;
  rough.velocity = kTileVelocity / testing::kCornerDepth_m;
  const std::vector<TileFlow> flows = flows_from(events, rough, world.camera());
  ASSERT_GT(flows.size(), 30U);
  const ImageF depth = world.depth(steady_glide(kTileEnd_s / 2));
  std::vector<double> errors_px;
  for (const TileFlow& tile : flows) {
    const Eigen::Vector2d pixel = world.camera().project(tile.ray.homogeneous());
    const double z = static_cast<double>(
        depth(static_cast<int>(pixel.x() + 0.5), static_cast<int>(pixel.y() + 0.5)));
    if (!(z > 0)) continue;
    const Eigen::Vector3d ray = tile.ray.homogeneous();
    const Eigen::Vector3d moved = -kTileRate.cross(ray) - kTileVelocity / z;
    const Eigen::Vector2d truth = moved.head<2>() - moved.z() * tile.ray;
    // By the strongest edges of the tile, over the window.
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(tile.information);
    errors_px.push_back(std::abs(eigen.eigenvectors().col(1).dot(tile.flow - truth)) * kTileEnd_s *
                        world.camera().fx);
  }
  // The picture moves by 11 px. Tiles on a slanted wall hold several flows, those at the border of
  // the plane in front may follow the other surface.
  std::sort(errors_px.begin(), errors_px.end());
  EXPECT_LT(errors_px[errors_px.size() / 2], 0.5);
  EXPECT_LT(errors_px[errors_px.size() * 3 / 4], 1);
}

/// An edge under an angle of 30 degrees to the rows that moves by 20 px in 40 ms along x.
TEST(TileFlow, ParallelEdgesTellTheirMotionAcrossThemselves) {
  const Eigen::Vector2d normal(0.5, std::sqrt(0.75));
  constexpr double kSpeed = 500;  // px/s along x
  Events events;
  for (int t = 0; t < 400; ++t)
    for (int y = 0; y < 180; ++y) {
      const double x = 60 + kSpeed * t * 1e-4 - (y - 30) * normal.y() / normal.x();
      if (x >= 0 && x < 240 && (t + y) % 4 == 0)
        events.push_back({static_cast<TimeNs>(t) * 100000, static_cast<std::uint16_t>(x),
                          static_cast<std::uint16_t>(y), 1});
    }
  PinholeCamera camera;
  camera.width = 240, camera.height = 180;
  camera.fx = camera.fy = 200, camera.cx = 119.5, camera.cy = 89.5;
  PlaneMotion rough;
  // Wrong by 1.4 px across the edge over the window, no whole step of the search.
  rough.velocity = Eigen::Vector3d(-(kSpeed - 70) / camera.fx, 0, 0);
  const std::vector<TileFlow> flows = flows_from(events, rough, camera);
  ASSERT_FALSE(flows.empty());
  const double across = kSpeed / camera.fx * normal.x();
  for (const TileFlow& tile : flows) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(tile.information);
    EXPECT_GT(std::abs(eigen.eigenvectors().col(1).dot(normal)), 0.9);
    EXPECT_LT(eigen.eigenvalues()[0], 0.2 * eigen.eigenvalues()[1]);
    EXPECT_NEAR(tile.flow.dot(normal), across, 0.04 * across) << "0.4 px of 10";
  }
}

TEST(TileFlow, OfEventsOfOneTimeIsNone) {
  Events events(1000, Event{5000, 20, 20, 1});
  PinholeCamera camera;
  camera.width = 3, camera.height = 2;
  camera.fx = camera.fy = 2, camera.cx = 1, camera.cy = 0.5;
  for (Event& event : events) event.x = event.y = 1;
  EXPECT_TRUE(flows_from(events, {}, camera).empty());
  events.back().t_ns += 1000;
  EXPECT_TRUE(flows_from(events, {}, camera).size() <= 1);
}

TEST(TileFlow, OfAFewEventsIsNone) {
  const testing::PlanarWorld world = testing::corner_world(240, 180);
  Events events = world.simulate(steady_glide, 0, kTileEnd_s, 1e-3, 0.15);
  events.resize(100);
  EXPECT_TRUE(flows_from(events, {}, world.camera()).empty());
}

}  // namespace
}  // namespace saccade
