#include "estimator/depth/outlier_removal.h"

#include <gtest/gtest.h>

#include "core/random.h"

namespace saccade {
namespace {

PinholeCamera square_camera() {
  PinholeCamera camera;
  camera.width = 100;
  camera.height = 100;
  camera.fx = camera.fy = 100;
  camera.cx = camera.cy = 50;
  return camera;
}

EdgePoint at(float x, float y, float depth) { return {x, y, 1 / depth, 0.01F}; }

TEST(OutlierRemoval, DropsLonelyPoints) {
  // Three neighbours at 2 m, 2 px = 0.04 m apart, one behind them, one far to the side.
  const std::vector<EdgePoint> points = {at(50, 50, 2), at(52, 50, 2), at(50, 52, 2),
                                         at(51, 51, 2.5), at(90, 50, 2)};
  const auto kept = without_outliers(points, square_camera(), 0.03, 2);
  ASSERT_EQ(kept.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(kept[i].x_px, points[i].x_px);
}

TEST(OutlierRemoval, TheRadiusGrowsWithTheDepth) {
  for (const float depth : {1.F, 10.F}) {
    const std::vector<EdgePoint> points = {at(50, 50, depth), at(52, 50, depth)};
    EXPECT_EQ(without_outliers(points, square_camera(), 0.03, 1).size(), 2U);
    EXPECT_EQ(without_outliers(points, square_camera(), 0.01, 1).size(), 0U);
  }
}

TEST(OutlierRemoval, KeepsEverythingWithoutNeighboursAsked) {
  EXPECT_EQ(without_outliers({at(50, 50, 2)}, square_camera(), 0.035, 0).size(), 1U);
  EXPECT_TRUE(without_outliers({}, square_camera()).empty());
}

TEST(OutlierRemoval, KeepsWhatComparingAllPointsKeeps) {
  const PinholeCamera camera{320, 240, 150, 160, 160, 120, {}};
  const Random random(5);
  std::vector<EdgePoint> points;
  // Wide rays, depths in layers and between them, and some points beside the image.
  for (std::uint64_t i = 0; i < 4000; ++i) {
    const double depth =
        random.uniform(i, 0) < 0.7 ? 2 + 0.02 * random.normal(i, 1) : 1 + 4 * random.uniform(i, 2);
    points.push_back(at(static_cast<float>(-10 + 340 * random.uniform(i, 3)),
                        static_cast<float>(-10 + 260 * random.uniform(i, 4)),
                        static_cast<float>(depth)));
  }
  std::vector<Eigen::Vector3d> positions;
  for (const EdgePoint& p : points)
    positions.emplace_back(camera.ray({p.x_px, p.y_px}) / static_cast<double>(p.inverse_depth));
  std::vector<EdgePoint> expected;
  for (std::size_t i = 0; i < points.size(); ++i) {
    int near = 0;
    for (std::size_t j = 0; j < points.size(); ++j)
      near += j != i && (positions[j] - positions[i]).norm() <= 0.035 * positions[i].z() ? 1 : 0;
    if (near >= 2) expected.push_back(points[i]);
  }
  ASSERT_GT(expected.size(), 300U);
  ASSERT_LT(expected.size(), 3900U);
  const std::vector<EdgePoint> kept = without_outliers(points, camera);
  ASSERT_EQ(kept.size(), expected.size());
  for (std::size_t i = 0; i < kept.size(); ++i) {
    EXPECT_EQ(kept[i].x_px, expected[i].x_px);
    EXPECT_EQ(kept[i].y_px, expected[i].y_px);
  }
}

}  // namespace
}  // namespace saccade
