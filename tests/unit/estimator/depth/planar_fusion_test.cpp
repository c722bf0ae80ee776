#include "estimator/depth/planar_fusion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/random.h"

namespace saccade {
namespace {

float plane(int x, int y) {
  return 0.5F + 0.002F * static_cast<float>(x) - 0.001F * static_cast<float>(y);
}

/// Points of a slanted plane on a grid, `noise` on their inverse depth.
std::vector<EdgeDepth> grid_of_points(double noise) {
  const Random random(3);
  std::vector<EdgeDepth> points;
  for (int y = 0; y < 40; y += 2)
    for (int x = 0; x < 40; x += 2)
      points.push_back({static_cast<float>(x), static_cast<float>(y),
                        plane(x, y) + static_cast<float>(noise * random.normal(0, points.size())),
                        static_cast<float>(noise)});
  return points;
}

float error_of(const EdgeDepth& p) {
  return p.inverse_depth - plane(static_cast<int>(p.x_px), static_cast<int>(p.y_px));
}

TEST(PlanarFusion, ReducesNoiseOnASlantedPlane) {
  constexpr double kNoise = 0.004;
  const auto points = fused(grid_of_points(kNoise), FusionOptions{});
  EXPECT_GT(points.size(), 380U);
  double squares = 0;
  for (const EdgeDepth& p : points) squares += std::pow(static_cast<double>(error_of(p)), 2);
  EXPECT_LT(std::sqrt(squares / static_cast<double>(points.size())), 0.5 * kNoise);
}

TEST(PlanarFusion, KeepsAStep) {
  std::vector<EdgeDepth> points = grid_of_points(0.001);
  for (EdgeDepth& p : points)
    if (p.x_px >= 20) p.inverse_depth += 0.2F;
  for (const EdgeDepth& p : fused(points, FusionOptions{}))
    EXPECT_NEAR(error_of(p), p.x_px >= 20 ? 0.2F : 0.F, 0.004F) << p.x_px;
}

TEST(PlanarFusion, DropsWhatStandsAlone) {
  std::vector<EdgeDepth> points = grid_of_points(0.001);
  points[205].inverse_depth += 0.3F;
  for (const EdgeDepth& p : fused(points, FusionOptions{})) EXPECT_NEAR(error_of(p), 0, 0.01F);
}

TEST(PlanarFusion, FewNeighboursMeanALargerSigma) {
  const std::vector<EdgeDepth> all = grid_of_points(0.002);
  std::vector<EdgeDepth> some;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (i / 20 % 3 == 0) some.push_back(all[i]);
  const auto dense = fused(all, FusionOptions{}), sparse = fused(some, FusionOptions{});
  ASSERT_FALSE(sparse.empty());
  const auto median = [](std::vector<EdgeDepth> points) {
    std::nth_element(points.begin(),
                     points.begin() + static_cast<std::ptrdiff_t>(points.size() / 2), points.end(),
                     [](const EdgeDepth& a, const EdgeDepth& b) { return a.sigma < b.sigma; });
    return points[points.size() / 2].sigma;
  };
  EXPECT_GT(median(sparse), 1.5F * median(dense));
}

TEST(PlanarFusion, WhatIsTooUncertainIsDropped) {
  FusionOptions options;
  options.max_sigma = 1e-5;
  EXPECT_TRUE(fused(grid_of_points(0.004), options).empty());
}

TEST(PlanarFusion, WithoutRadiusNothingChanges) {
  FusionOptions options;
  options.plane.radius_px = 0;
  EXPECT_EQ(fused(grid_of_points(0.004), options).size(), 400U);
}

}  // namespace
}  // namespace saccade
