#include "estimator/edges/window/observed_edges.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <map>

#include "estimator/depth/depth_config.h"
#include "tests/support/planar_world.h"

namespace saccade {
namespace {

using testing::corner_glide;
using testing::corner_world;
using testing::PlanarWorld;
using testing::trajectory_of;

constexpr double kEnd_s = 0.3;
constexpr double kGivenUntil_s = 0.15;
constexpr double kSpacing_s = 0.05;

/// The most events of one edge that count after each node of a correction over kEnd_s.
std::map<int, std::size_t> most_after_nodes(int given_pairs) {
  static const PlanarWorld world = corner_world(160, 120);
  static const Events events = world.simulate(corner_glide, 0, kEnd_s, 1e-3, 0.15);
  static const Trajectory path = trajectory_of(corner_glide, kEnd_s);
  static const ViewWindow window{events, &path, kEnd_s / 2};
  static const DepthConfig config;
  static const WindowEdgels edges =
      RayDepth(config.rays, config.limits, world.camera()).find_edgels(window);
  const NodeCorrection correction(0, kEnd_s, kSpacing_s);
  const ObservedEdges observed(window, edges, world.camera(), correction,
                               [&](double t_s) { return t_s < kGivenUntil_s ? given_pairs : 1; });
  std::map<int, std::size_t> most;
  for (const FittedEdgel& edge : edges.edges) {
    std::map<int, std::size_t> own;
    for (const ObservedEvent& event : observed.of(edge)) ++own[event.node];
    for (const auto& [node, count] : own) most[node] = std::max(most[node], count);
  }
  return most;
}

TEST(ObservedEdges, AsManyEventsCountBetweenTwoNodesAsArePaired) {
  const std::map<int, std::size_t> most = most_after_nodes(1);
  ASSERT_EQ(most.size(), 6U);
  for (const auto& [node, count] : most) EXPECT_EQ(count, 2U) << node;
}

TEST(ObservedEdges, MoreOfThemCountWhileThePosesAreGiven) {
  const std::map<int, std::size_t> most = most_after_nodes(3);
  ASSERT_EQ(most.size(), 6U);
  for (const auto& [node, count] : most) EXPECT_EQ(count, node < 3 ? 6U : 2U) << node;
}

}  // namespace
}  // namespace saccade
