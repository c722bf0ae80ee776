#include "estimator/depth/rays/planar_fusion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/random.h"

namespace saccade {
namespace {

float slanted(int x, int y) {
  return 0.5F + 0.002F * static_cast<float>(x) - 0.001F * static_cast<float>(y);
}

/// Points of a slanted plane on a grid, `noise` on their inverse depth.
std::vector<EdgePoint> grid_of_points(double noise) {
  const Random random(3);
  std::vector<EdgePoint> points;
  for (int y = 0; y < 40; y += 2)
    for (int x = 0; x < 40; x += 2)
      points.push_back({static_cast<float>(x), static_cast<float>(y),
                        slanted(x, y) + static_cast<float>(noise * random.normal(0, points.size())),
                        static_cast<float>(noise)});
  return points;
}

float error_of(const EdgePoint& p) {
  return p.inverse_depth - slanted(static_cast<int>(p.x_px), static_cast<int>(p.y_px));
}

TEST(PlanarFusion, ReducesNoiseOnASlantedPlane) {
  constexpr double kNoise = 0.004;
  const auto points = fuse_planes(grid_of_points(kNoise), FusionOptions{});
  EXPECT_GT(points.size(), 380U);
  double squares = 0;
  for (const EdgePoint& p : points) squares += std::pow(static_cast<double>(error_of(p)), 2);
  EXPECT_LT(std::sqrt(squares / static_cast<double>(points.size())), 0.5 * kNoise);
}

TEST(PlanarFusion, TheNoiseOfThePosesAveragesOverNoNeighbours) {
  std::vector<EdgePoint> points = grid_of_points(0.004);
  for (EdgePoint& p : points) p.pose_sigma = 0.005F;
  for (const EdgePoint& p : fuse_planes(points, FusionOptions{})) EXPECT_GT(p.sigma, 0.005F);
  for (EdgePoint& p : points) p.pose_sigma = 0.1F;
  EXPECT_TRUE(fuse_planes(points, FusionOptions{}).empty());
}

TEST(PlanarFusion, KeepsAStep) {
  std::vector<EdgePoint> points = grid_of_points(0.001);
  for (EdgePoint& p : points)
    if (p.x_px >= 20) p.inverse_depth += 0.2F;
  for (const EdgePoint& p : fuse_planes(points, FusionOptions{}))
    EXPECT_NEAR(error_of(p), p.x_px >= 20 ? 0.2F : 0.F, 0.004F) << p.x_px;
}

TEST(PlanarFusion, DropsWhatStandsAlone) {
  std::vector<EdgePoint> points = grid_of_points(0.001);
  points[205].inverse_depth += 0.3F;
  for (const EdgePoint& p : fuse_planes(points, FusionOptions{}))
    EXPECT_NEAR(error_of(p), 0, 0.01F);
}

TEST(PlanarFusion, FewNeighboursMeanALargerSigma) {
  const std::vector<EdgePoint> all = grid_of_points(0.002);
  std::vector<EdgePoint> some;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (i / 20 % 3 == 0) some.push_back(all[i]);
  FusionOptions options;
  options.position_sigma_px = 0;  // alike in both
  const auto dense = fuse_planes(all, options), sparse = fuse_planes(some, options);
  ASSERT_FALSE(sparse.empty());
  const auto median = [](std::vector<EdgePoint> points) {
    std::nth_element(points.begin(),
                     points.begin() + static_cast<std::ptrdiff_t>(points.size() / 2), points.end(),
                     [](const EdgePoint& a, const EdgePoint& b) { return a.sigma < b.sigma; });
    return points[points.size() / 2].sigma;
  };
  EXPECT_GT(median(sparse), 1.5F * median(dense));
}

/// A near surface left of column 20, one behind it from column 25 on, and points on the contour.
std::vector<EdgePoint> contour_points() {
  std::vector<EdgePoint> points;
  for (int y = 0; y < 40; y += 2)
    for (int x = 0; x < 40; x += 2) {
      if (x > 20 && x < 25) continue;
      points.push_back(
          {static_cast<float>(x), static_cast<float>(y), x <= 20 ? 0.5F : 0.3F, 1e-3F});
      points.back().normal = {1, 0};
    }
  return points;
}

TEST(PlanarFusion, PointsOnAContourMoveOntoTheirSurface) {
  int moved = 0;
  for (const EdgePoint& p : fuse_planes(contour_points(), FusionOptions{})) {
    const bool is_on_contour = std::abs(p.x_px - 19.5F) < 0.1F;
    EXPECT_TRUE(is_on_contour || std::lround(p.x_px) % 2 == 0) << p.x_px;
    EXPECT_NEAR(p.inverse_depth, p.x_px < 22 ? 0.5F : 0.3F, 1e-4F);
    moved += is_on_contour ? 1 : 0;
  }
  EXPECT_EQ(moved, 20);
}

TEST(PlanarFusion, WithNothingBehindNoPointMoves) {
  std::vector<EdgePoint> points = contour_points();
  std::erase_if(points, [](const EdgePoint& p) { return p.x_px > 22; });
  for (const EdgePoint& p : fuse_planes(points, FusionOptions{}))
    EXPECT_EQ(std::lround(p.x_px * 2) % 4, 0) << p.x_px;
}

TEST(PlanarFusion, SteepSurfacesAndDisagreementMeanALargerSigma) {
  const std::vector<EdgePoint> slanted = grid_of_points(1e-5);
  std::vector<EdgePoint> flat = slanted;
  for (EdgePoint& p : flat) p.inverse_depth = 0.5F;
  EXPECT_GT(fuse_planes(slanted, FusionOptions{})[210].sigma,
            2 * fuse_planes(flat, FusionOptions{})[210].sigma);
  flat[210].inverse_depth += 0.004F;
  flat[210].sigma = 0.002F;
  const auto points = fuse_planes(flat, FusionOptions{});
  EXPECT_GT(points[210].sigma, 2 * points[300].sigma);
}

TEST(PlanarFusion, WhatIsTooUncertainIsDropped) {
  FusionOptions options;
  options.max_sigma = 1e-5;
  EXPECT_TRUE(fuse_planes(grid_of_points(0.004), options).empty());
}

}  // namespace
}  // namespace saccade
