#include "estimator/depth/outlier_removal.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace saccade
