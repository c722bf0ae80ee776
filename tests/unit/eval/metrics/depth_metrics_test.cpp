#include "eval/metrics/depth_metrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace saccade {
namespace {

/// 2 m on the left, 4 m on the right of column 10.
DepthTruth step() {
  DepthTruth truth;
  truth.depth = ImageF(20, 20, 2);
  for (int y = 0; y < 20; ++y)
    for (int x = 10; x < 20; ++x) truth.depth(x, y) = 4;
  truth.edges = ImageU8(20, 20);
  truth.has_edges = true;
  return truth;
}

DepthPoint at(double x, double y, double depth, std::optional<double> sigma = std::nullopt) {
  return {{x, y}, depth, sigma};
}

TEST(DepthMetrics, TakesTheBestOfTheNeighbourhoodAndTheStrictPosition) {
  // One pixel left of the step, but with the depth behind it.
  const std::vector<DepthPoint> points = {at(9.2, 5, 4.04), at(4, 4, 2.2)};
  const DepthErrors errors = compare_depth(points, step(), 1);
  ASSERT_EQ(errors.best.size(), 2U);
  EXPECT_NEAR(errors.best[0].relative, 0.01, 1e-6);
  EXPECT_NEAR(errors.strict[0].relative, 1.02, 1e-6);
  EXPECT_NEAR(errors.best[1].relative, 0.1, 1e-6);
  EXPECT_NEAR(errors.strict[1].relative, 0.1, 1e-6);
}

TEST(DepthMetrics, InterpolatesOneOverDepthAtTheStrictPosition) {
  DepthTruth truth = step();
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < 20; ++x) truth.depth(x, y) = static_cast<float>(1 / (0.5 - 0.004 * x));
  const double exact = 1 / (0.5 - 0.004 * 6.3);
  const std::vector<DepthPoint> points = {at(6.3, 4.8, exact)};
  EXPECT_LT(compare_depth(points, truth, 0).strict[0].relative, 1e-6);
}

TEST(DepthMetrics, ScoresByHand) {
  std::vector<DepthPoint> points = {at(3, 3, 2.02, 0.03), at(5, 5, 2.2, 0.11), at(7, 7, 3, 0.4),
                                    at(16, 16, 4, 0.1)};
  DepthTruth truth = step();
  truth.edges(3, 4) = 1;   // next to a point
  truth.edges(16, 3) = 1;  // far from all
  const DepthErrors view = compare_depth(points, truth, 0);
  Metrics m;
  set_depth_scores(m, std::vector<DepthErrors>{view});
  // Relative: 0.01, 0.1, 0.5, 0.
  EXPECT_NEAR(*m.get("depth.rel_mean"), 0.1525, 1e-6);
  EXPECT_NEAR(*m.get("depth.rel_median"), 0.055, 1e-6);
  EXPECT_NEAR(*m.get("depth.rmse_m"), std::sqrt((0.0004 + 0.04 + 1) / 4), 1e-6);
  EXPECT_NEAR(*m.get("depth.delta_1_25"), 0.75, 1e-12);
  EXPECT_NEAR(*m.get("depth.outlier_5_percent"), 0.5, 1e-12);
  EXPECT_NEAR(*m.get("depth.within_1_sigma"), 0.5, 1e-12);
  EXPECT_NEAR(*m.get("depth.within_2_sigma"), 0.75, 1e-12);
  EXPECT_EQ(*m.get("depth.points"), 4);
  EXPECT_NEAR(*m.get("depth.completeness"), 0.5, 1e-12);
}

TEST(DepthMetrics, StatesMedianAndWorstOfTheViews) {
  const DepthTruth truth = step();
  std::vector<DepthErrors> views;
  for (const double depth : {2.02, 2.06, 2.2})
    views.push_back(compare_depth(std::vector<DepthPoint>{at(3, 3, depth)}, truth, depth));
  views[0].points = 7;
  Metrics m;
  set_depth_scores(m, views);
  EXPECT_NEAR(*m.get("depth.views.rel_mean.median"), 0.03, 1e-6);
  EXPECT_NEAR(*m.get("depth.views.rel_mean.worst"), 0.1, 1e-6);
  EXPECT_EQ(*m.get("depth.views.points.median"), 1);
  EXPECT_EQ(*m.get("depth.views.points.worst"), 1);
  EXPECT_EQ(*m.get("depth.views.count"), 3);
  // A view without a point has no error to state: the worst is unknown, never a pass.
  views.push_back(compare_depth({}, truth, 9));
  Metrics with_empty;
  set_depth_scores(with_empty, views);
  EXPECT_EQ(with_empty.get("depth.views.rel_mean.worst"), std::nullopt);
  EXPECT_EQ(*with_empty.get("depth.views.points.worst"), 0);
}

TEST(DepthMetrics, WhatIsUnknownIsNull) {
  DepthTruth truth = step();
  truth.depth.fill(0);
  truth.has_edges = false;
  Metrics m;
  set_depth_scores(
      m, std::vector<DepthErrors>{compare_depth(std::vector<DepthPoint>{at(3, 3, 2)}, truth, 0)});
  EXPECT_EQ(*m.get("depth.points"), 1);
  for (const char* key : {"rel_mean", "rel_median", "rmse_m", "delta_1_25", "completeness",
                          "within_1_sigma", "strict.rel_mean"})
    EXPECT_EQ(m.get(std::string("depth.") + key), std::nullopt) << key;
  // Points outside the picture are nobody's.
  EXPECT_EQ(compare_depth(std::vector<DepthPoint>{at(30, 3, 2)}, step(), 0).points, 0U);
}

}  // namespace
}  // namespace saccade
