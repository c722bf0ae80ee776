#include "estimator/tracking/intensity_map.h"
#include "estimator/tracking/tracker.h"

#include <gtest/gtest.h>

#include <cmath>

namespace saccade {
namespace {

PinholeCamera tiny_camera() {
  PinholeCamera camera;
  camera.width = 24;
  camera.height = 18;
  camera.fx = camera.fy = 20;
  camera.cx = 11.5;
  camera.cy = 8.5;
  return camera;
}

/// A faint pattern with an upright step at x = 12, everywhere 2 m away.
ReferenceView view_with_step(float step) {
  ReferenceView view{ImageF(24, 18), ImageF(24, 18, 2), {}};
  for (int y = 0; y < 18; ++y)
    for (int x = 0; x < 24; ++x)
      view.log_intensity(x, y) =
          -1 + 0.02F * static_cast<float>((3 * x + 5 * y) % 7) + (x >= 12 ? step : 0);
  return view;
}

IntensityMap map_of(const ReferenceView& view, double edge_blur_px = IntensityMap::kEdgeBlur_px) {
  return {tiny_camera(), std::span(&view, 1), edge_blur_px};
}

TEST(IntensityMap, SmoothesAtStrongEdgesOnly) {
  const ReferenceView view = view_with_step(2.5F);
  const IntensityMap map = map_of(view);
  EXPECT_GT(map.atlas()(11, 9), view.log_intensity(11, 9) + 0.3F);
  EXPECT_LT(map.atlas()(12, 9), view.log_intensity(12, 9) - 0.3F);
  for (int y = 0; y < 18; ++y)
    for (int x = 0; x < 24; ++x)
      if (x < 9 || x > 14) {
        EXPECT_EQ(map.atlas()(x, y), view.log_intensity(x, y)) << x << " " << y;
      }
}

TEST(IntensityMap, FaintEdgesStayAsTheyAre) {
  const ReferenceView view = view_with_step(0.7F);
  EXPECT_EQ(map_of(view).atlas(), view.log_intensity);
}

TEST(IntensityMap, SmoothesTheMoreTheStrongerTheEdge) {
  // From a difference of 0.9 on, fully from twice that on: 0, 1/2 and 1 of a Gaussian's change,
  // which is itself in proportion to the difference.
  const auto change = [](float step) {
    ReferenceView view = view_with_step(step);
    for (int y = 0; y < 18; ++y)
      for (int x = 0; x < 24; ++x) view.log_intensity(x, y) = x >= 12 ? step : 0;
    return map_of(view).atlas()(11, 9) / step;
  };
  const float fully = change(2.7F);
  EXPECT_GT(fully, 0.1F);
  EXPECT_FLOAT_EQ(change(1.8F), fully);
  EXPECT_FLOAT_EQ(change(1.35F), fully / 2);
  EXPECT_EQ(change(0.9F), 0);
}

TEST(IntensityMap, NoBlurLeavesThePicture) {
  const ReferenceView view = view_with_step(4);
  EXPECT_EQ(map_of(view, 0).atlas(), view.log_intensity);
}

TEST(IntensityMap, WhatIsUnknownStaysSoAndSpreadsNowhere) {
  ReferenceView view = view_with_step(2.5F);
  for (int y = 0; y < 18; ++y) view.log_intensity(13, y) = kUnknownLogIntensity;
  const IntensityMap map = map_of(view);
  for (int y = 0; y < 18; ++y)
    for (int x = 0; x < 24; ++x) EXPECT_EQ(std::isnan(map.atlas()(x, y)), x == 13);
  EXPECT_EQ(map.views()[0].inverse_depth[5 * 24 + 13], 0);
}

TEST(IntensityMap, PointsAreThePixelsAtTheirDepth) {
  ReferenceView view = view_with_step(1);
  view.depth(3, 4) = 0;
  view.depth(20, 7) = 1.25F;
  const IntensityMap map = map_of(view);
  const IntensityMap::View& lifted = map.views()[0];
  EXPECT_EQ(lifted.inverse_depth[4 * 24 + 3], 0);
  EXPECT_FLOAT_EQ(lifted.inverse_depth[7 * 24 + 20], 0.8F);
  const Eigen::Vector3d point = lifted.points[7 * 24 + 20].cast<double>();
  EXPECT_LT((point - 1.25 * tiny_camera().ray({20, 7})).norm(), 1e-6);
}

TEST(IntensityMap, PicturesOfSeveralViewsLieOneBelowTheOther) {
  std::vector<ReferenceView> views{view_with_step(0.1F), view_with_step(0.3F)};
  const Rigid3 world_from_first(so3_exp({0.3, -0.2, 1}), {1, 2, 3});
  const Rigid3 first_from_second(so3_exp({0, 0.4, 0}), {0.5, 0, -0.1});
  views[0].world_from_reference = world_from_first;
  views[1].world_from_reference = world_from_first * first_from_second;
  const IntensityMap map(tiny_camera(), views, IntensityMap::kEdgeBlur_px);
  ASSERT_EQ(map.views().size(), 2U);
  EXPECT_EQ(map.atlas().width(), 24);
  EXPECT_EQ(map.atlas().height(), 37);
  EXPECT_EQ(map.views()[0].first_row, 0);
  EXPECT_EQ(map.views()[1].first_row, 19);
  for (int y = 0; y < 18; ++y)
    for (int x = 0; x < 24; ++x) {
      EXPECT_EQ(map.atlas()(x, y), views[0].log_intensity(x, y));
      EXPECT_EQ(map.atlas()(x, 19 + y), views[1].log_intensity(x, y));
    }
  for (int x = 0; x < 24; ++x) EXPECT_TRUE(std::isnan(map.atlas()(x, 18)));
  // The map's frame is that of the first view, and so are all points.
  EXPECT_LT((map.world_from_map().inverse() * world_from_first).log().norm(), 1e-9);
  EXPECT_LT((map.views()[1].view_from_map * first_from_second).log().norm(), 1e-9);
  const Eigen::Vector3d point = map.views()[1].points[7 * 24 + 20].cast<double>();
  EXPECT_LT((point - first_from_second * (2 * tiny_camera().ray({20, 7}))).norm(), 1e-6);
}

}  // namespace
}  // namespace saccade
