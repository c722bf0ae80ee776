#include "estimator/edges/edge_matches.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace saccade {
namespace {

const PinholeCamera kCamera{.width = 240, .height = 180, .fx = 200, .fy = 210, .cx = 119, .cy = 89};

FittedEdgel edge_at(float x, float y, float angle, float depth_m) {
  FittedEdgel fitted;
  fitted.edge.pixel = {x, y};
  fitted.edge.normal = {std::cos(angle), std::sin(angle)};
  fitted.edge.inverse_depth = 1 / depth_m;
  fitted.sigma = 0.01F;
  return fitted;
}

TEST(TransformedEdge, IsTheSamePointAndLineInTheWorld) {
  const Rigid3 other_from_view =
      Rigid3::exp((Twist() << 0.1, -0.05, 0.2, 0.02, 0.1, 0.3).finished());
  const FittedEdgel edge = edge_at(100, 70, 0.6F, 2.5F);
  const auto seen = transformed(other_from_view, edge, kCamera);
  ASSERT_TRUE(seen);
  const auto in_space = [](const FittedEdgel& fitted, float along) -> Eigen::Vector3d {
    const Eigen::Vector2f pixel = fitted.edge.pixel + along * fitted.edge.tangent();
    return kCamera.ray(pixel.cast<double>()) / static_cast<double>(fitted.edge.inverse_depth);
  };
  EXPECT_LT((other_from_view * in_space(edge, 0) - in_space(*seen, 0)).norm(), 1e-5);
  // A point along the edge lies on its line in the other view.
  const Eigen::Vector2d along = kCamera.project(other_from_view * in_space(edge, 2));
  const Eigen::Vector2d away = along - seen->edge.pixel.cast<double>();
  EXPECT_NEAR(away.dot(seen->edge.normal.cast<double>()), 0, 1e-4);
  // Relative to the depth it is as sure as before, and its brighter side is the same.
  EXPECT_NEAR(seen->sigma / seen->edge.inverse_depth, edge.sigma / edge.edge.inverse_depth, 1e-6);
  const Eigen::Vector2d brighter =
      kCamera.project(other_from_view * (in_space(edge, 0) +
                                         Eigen::Vector3d(std::cos(0.6), std::sin(0.6), 0) * 0.01)) -
      seen->edge.pixel.cast<double>();
  EXPECT_GT(brighter.dot(seen->edge.normal.cast<double>()), 0);
}

TEST(TransformedEdge, NothingBehindTheCamera) {
  const Rigid3 beyond = Rigid3::exp((Twist() << 0, 0, -3, 0, 0, 0).finished());
  EXPECT_FALSE(transformed(beyond, edge_at(100, 70, 0, 2), kCamera));
}

class EdgeMatching : public ::testing::Test {
 protected:
  [[nodiscard]] std::optional<std::size_t> found(const FittedEdgel& edge) const {
    return EdgeMatcher(edges_, other_from_view_, kCamera).match(edge.edge);
  }

  Rigid3 other_from_view_ = Rigid3::exp((Twist() << 0.2, 0, 0.1, 0, 0.05, 0.1).finished());
  std::vector<FittedEdgel> edges_ = {edge_at(60, 70, 0.2F, 2), edge_at(100, 80, 1.2F, 2.5F),
                                     edge_at(140, 90, -2, 3)};
};

TEST_F(EdgeMatching, FindsTheEdgeFromAnotherView) {
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    auto seen = transformed(other_from_view_, edges_[i], kCamera);
    ASSERT_TRUE(seen);
    seen->edge.pixel.x() += 1;
    seen->edge.inverse_depth *= 1.05F;
    EXPECT_EQ(found(*seen), i);
  }
}

TEST_F(EdgeMatching, NotOneElsewhereAtAnotherDepthOrTheOtherWayRound) {
  const auto seen = transformed(other_from_view_, edges_[1], kCamera);
  ASSERT_TRUE(seen);
  FittedEdgel elsewhere = *seen, nearer = *seen, across = *seen, darker = *seen;
  elsewhere.edge.pixel.y() += 3;
  nearer.edge.inverse_depth *= 1.2F;
  across.edge.normal = seen->edge.tangent();
  darker.edge.normal = -seen->edge.normal;
  for (const FittedEdgel& other : {elsewhere, nearer, across, darker}) EXPECT_FALSE(found(other));
  EXPECT_TRUE(found(*seen));
}

TEST_F(EdgeMatching, ReobservationsAreEdgesOfLaterViewsThatAreFarEnoughAway) {
  const std::vector<Rigid3> poses = {Rigid3(), Rigid3(), other_from_view_.inverse()};
  std::vector<EdgeView> views(3);
  for (std::size_t i = 0; i < views.size(); ++i) {
    views[i].t_s = static_cast<double>(i);
    views[i].from_s = views[i].t_s - 0.75;
    views[i].until_s = views[i].t_s + 0.75;
  }
  views[0].edges = views[1].edges = edges_;
  // The last view sees the third edge first, and the second one not at all.
  for (const std::size_t i : {2U, 0U}) {
    const auto seen = transformed(other_from_view_, edges_[i], kCamera);
    ASSERT_TRUE(seen);
    views[2].edges.push_back(*seen);
  }
  const std::vector<EdgeOfView> edges{{0, 0}, {0, 1}, {0, 2}, {1, 0}, {2, 0}};
  const auto again = reobservations(edges, views, poses, Reobserving::kLater, kCamera);
  ASSERT_EQ(again.size(), 5U);
  ASSERT_EQ(again[0].size(), 1U);
  EXPECT_EQ(again[0][0].view, 2U);
  EXPECT_EQ(again[0][0].edge, 1U);
  EXPECT_TRUE(again[1].empty());
  ASSERT_EQ(again[2].size(), 1U);
  EXPECT_EQ(again[2][0].edge, 0U);
  EXPECT_TRUE(again[3].empty()) << "the windows overlap";
  EXPECT_TRUE(again[4].empty()) << "none is later";
  const auto before = reobservations(edges, views, poses, Reobserving::kEarlier, kCamera);
  ASSERT_EQ(before[4].size(), 1U);
  EXPECT_EQ(before[4][0].view, 0U);
  EXPECT_EQ(before[4][0].edge, 2U);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_TRUE(before[i].empty());
}

}  // namespace
}  // namespace saccade
