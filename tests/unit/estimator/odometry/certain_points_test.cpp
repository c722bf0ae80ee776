#include "estimator/odometry/certain_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace saccade {
namespace {

constexpr PinholeCamera kCamera{
    .width = 240, .height = 180, .fx = 200, .fy = 200, .cx = 120, .cy = 90};

/// So many points at a pixel, their relative sigmas alike.
void add(std::vector<EdgePoint>& points, int count, float x_px, float y_px, float sigma) {
  constexpr float kInverseDepth = 0.5F;
  for (int i = 0; i < count; ++i)
    points.push_back({x_px, y_px, kInverseDepth, sigma * kInverseDepth, {1, 0}, 0});
}

long points_at(const std::vector<EdgePoint>& points, float x_px, float sigma) {
  return std::ranges::count_if(points, [&](const EdgePoint& point) {
    return point.x_px == x_px && point.sigma == sigma * point.inverse_depth;
  });
}

TEST(CertainPoints, OthersAreKeptInPartsThatHaveFew) {
  std::vector<EdgePoint> points;
  for (const float x_px : {10.0F, 40.0F, 70.0F}) {
    add(points, x_px == 10 ? 8 : 7, x_px, 20, 0.02F);
    add(points, x_px == 40 ? 0 : 5, x_px, 20, 0.1F);
    add(points, 3, x_px, 20, 0.3F);
  }
  // The same column, another row: each part counts by itself.
  add(points, 20, 40, 100, 0.02F);
  keep_certain(kCamera, 0.05, points);
  EXPECT_EQ(points_at(points, 10, 0.02F), 8);
  EXPECT_EQ(points_at(points, 10, 0.1F), 0) << "there are enough certain ones";
  EXPECT_EQ(points_at(points, 10, 0.3F), 0);
  EXPECT_EQ(points_at(points, 40, 0.02F), 7 + 20);
  EXPECT_EQ(points_at(points, 40, 0.3F), 3) << "one is missing";
  EXPECT_EQ(points_at(points, 70, 0.1F), 5);
  EXPECT_EQ(points_at(points, 70, 0.3F), 0) << "the less certain ones make up for it";
}

TEST(CertainPoints, APointBesideTheViewCountsAtItsBorder) {
  std::vector<EdgePoint> points;
  add(points, 8, 239.4F, 179.4F, 0.02F);
  add(points, 1, 241, 181, 0.3F);
  add(points, 1, -1, -1, 0.3F);
  keep_certain(kCamera, 0.05, points);
  EXPECT_EQ(points_at(points, 241, 0.3F), 0);
  EXPECT_EQ(points_at(points, -1, 0.3F), 1);
}

}  // namespace
}  // namespace saccade
