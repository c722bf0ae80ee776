#include "estimator/odometry/start/flow_motion.h"

#include <gtest/gtest.h>

#include <vector>

#include "core/median.h"
#include "core/random.h"

namespace saccade {
namespace {

const Eigen::Vector3d kFlowVelocity(0.3, -0.1, 0.25);
const Eigen::Vector3d kFlowRate(-1.5, 0.4, -1.1);

double inverse_depth_of(std::uint64_t tile) { return 0.5 + Random(11).uniform(0, tile); }

/// What tiles of a picture 60 degrees wide see, 1 / z between 0.5 and 1.5; `edges` directions in
/// each, `noise` on every flow.
std::vector<TileFlow> flows_of(const Eigen::Vector3d& velocity, int edges, double noise) {
  const Random random(11);
  std::vector<TileFlow> tiles;
  for (int v = -3; v < 3; ++v)
    for (int u = -4; u < 4; ++u) {
      const std::uint64_t k = tiles.size();
      TileFlow tile;
      tile.ray = Eigen::Vector2d(0.15 * (u + 0.5), 0.15 * (v + 0.5));
      const double inverse_depth = inverse_depth_of(k);
      const Eigen::Vector3d ray = tile.ray.homogeneous();
      const Eigen::Vector3d moved = -kFlowRate.cross(ray) - inverse_depth * velocity;
      tile.flow = moved.head<2>() - moved.z() * tile.ray +
                  noise * Eigen::Vector2d(random.normal(1, k), random.normal(2, k));
      for (int i = 0; i < edges; ++i) {
        const double angle = 6.28 * random.uniform(3 + static_cast<std::uint64_t>(i), k);
        const Eigen::Vector2d normal(std::cos(angle), std::sin(angle));
        tile.information += 1000 * normal * normal.transpose();
      }
      tiles.push_back(tile);
    }
  return tiles;
}

TEST(FlowMotion, OfExactFlowsIsExact) {
  const FlowMotion found = fit_motion(flows_of(kFlowVelocity, 3, 0));
  EXPECT_LT(angle_deg(found.velocity, kFlowVelocity), 0.5);
  EXPECT_LT((found.rate - kFlowRate).norm(), 0.01);
  EXPECT_LT(found.direction_deg, 1);
  EXPECT_NEAR(median(found.inverse_depth), 1, 1e-9) << "the typical depth is the unit";
  const std::vector<TileFlow> tiles = flows_of(kFlowVelocity, 3, 0);
  const double unit = found.velocity.norm() / kFlowVelocity.norm();
  for (std::size_t k = 0; k < tiles.size(); ++k)
    EXPECT_NEAR(found.inverse_depth[k] * unit, inverse_depth_of(k), 0.02);
}

TEST(FlowMotion, StatesHowWellItIsKnown) {
  // Of a flow of 1.5 / s, and 0.4 / s of it by the translation.
  const FlowMotion found = fit_motion(flows_of(kFlowVelocity, 3, 0.005));
  EXPECT_LT(angle_deg(found.velocity, kFlowVelocity), 2 * found.direction_deg);
  EXPECT_GT(found.direction_deg, 1);
  EXPECT_LT(found.direction_deg, 15);
}

TEST(FlowMotion, OneMovingTileIsAnOutlier) {
  std::vector<TileFlow> tiles = flows_of(kFlowVelocity, 3, 1e-4);
  tiles[17].flow += Eigen::Vector2d(0.5, -0.8);
  EXPECT_LT(angle_deg(fit_motion(tiles).velocity, kFlowVelocity), 2);
}

TEST(FlowMotion, OfOneEdgeInEveryTileOnlyTheSignsTell) {
  // Some depth explains the speed of one edge; that it is not behind the camera is all there is.
  const FlowMotion found = fit_motion(flows_of(kFlowVelocity, 1, 0.005));
  EXPECT_LT(angle_deg(found.velocity, kFlowVelocity), 30);
}

TEST(FlowMotion, ARotationHasNoDirection) {
  const FlowMotion found = fit_motion(flows_of(Eigen::Vector3d::Zero(), 3, 0.005));
  EXPECT_GT(found.direction_deg, 45);
  EXPECT_LT((found.rate - kFlowRate).norm(), 0.1);
  EXPECT_LT((found.rotation - kFlowRate).norm(), 0.02);
}

TEST(FlowMotion, StatesTheOtherMotionsThatAreLikely) {
  EXPECT_TRUE(fit_motion(flows_of(kFlowVelocity, 3, 0.001)).others.empty());
  const FlowMotion found = fit_motion(flows_of(Eigen::Vector3d::Zero(), 3, 0.005));
  ASSERT_FALSE(found.others.empty());
  for (std::size_t i = 0; i < found.others.size(); ++i) {
    EXPECT_GE(angle_deg(found.others[i].velocity, found.velocity), 25);
    EXPECT_LT((found.others[i].rate - kFlowRate).norm(), 0.1);
    for (std::size_t k = 0; k < i; ++k)
      EXPECT_GE(angle_deg(found.others[i].velocity, found.others[k].velocity), 25);
  }
  EXPECT_TRUE(fit_motion(flows_of(Eigen::Vector3d::Zero(), 3, 0.005), false).others.empty());
}

}  // namespace
}  // namespace saccade
