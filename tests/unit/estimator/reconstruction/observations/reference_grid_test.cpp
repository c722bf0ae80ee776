#include "estimator/reconstruction/observations/reference_grid.h"

#include <gtest/gtest.h>

namespace saccade {
namespace {

TEST(ReferenceGrid, GoesAroundWhereAPanoramaWraps) {
  const ReferenceGrid grid(Panorama::sphere(40));
  for (const float x : {39.25F, -0.75F, 79.25F}) {
    const GridPoint point = grid.at(x, 3);
    EXPECT_EQ(point.index[0] % 40, 39);
    EXPECT_EQ(point.index[1] % 40, 0);
    EXPECT_NEAR(point.weight[1] + point.weight[3], 0.25F, 1e-4F);
  }
  EXPECT_EQ(grid.nearest(39.75F, 2), 80U);
  EXPECT_EQ(grid.right_of(39, 2), 80);
  EXPECT_EQ(ReferenceGrid(Panorama{40, 3, 0, 30, 20}).right_of(29, 2), -1);
}

TEST(ReferenceGrid, DoesNotMixSurfaces) {
  ImageF inverse_depth(4, 4, 1.0F);
  for (int y = 0; y < 4; ++y)
    for (int x = 2; x < 4; ++x) inverse_depth(x, y) = 0.5F;
  const ReferenceGrid grid(inverse_depth);
  const GridPoint left = grid.at(1.4F, 1.0F);
  EXPECT_FLOAT_EQ(left.weight[0], 1);
  EXPECT_FLOAT_EQ(left.weight[1], 0);
  const GridPoint right = grid.at(1.6F, 1.0F);
  EXPECT_FLOAT_EQ(right.weight[0], 0);
  EXPECT_FLOAT_EQ(right.weight[1], 1);
  EXPECT_FALSE(grid.is_joined(1, 2));
}

}  // namespace
}  // namespace saccade
