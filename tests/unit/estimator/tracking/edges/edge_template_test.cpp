#include "estimator/tracking/edges/edge_template.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "tests/unit/estimator/tracking/edges/synthetic_template.h"

namespace saccade {
namespace {

using testing::add_point;
using testing::rectangle_map;
using testing::small_camera;

/// No blur and no threshold on the slope: the template is what was drawn.
TemplateOptions plain(bool bilinear) {
  TemplateOptions options;
  options.bilinear = bilinear;
  options.blur_size_px = 1;
  options.min_gradient_px = 0;
  return options;
}

Eigen::Vector2i pixel_of(const TemplatePoint& p) {
  const PinholeCamera c = small_camera();
  return {static_cast<int>(std::lround(p.ray.x() * c.fx + c.cx)),
          static_cast<int>(std::lround(p.ray.y() * c.fy + c.cy))};
}

std::optional<TemplatePoint> find(std::span<const TemplatePoint> points, int x, int y) {
  for (const TemplatePoint& p : points)
    if (pixel_of(p) == Eigen::Vector2i(x, y)) return p;
  return std::nullopt;
}

MapPoints one_point(const Eigen::Vector2d& pixel, double depth) {
  MapPoints map;
  add_point(map, depth * small_camera().ray(pixel));
  return map;
}

TEST(EdgeTemplate, ProjectsIntoTheMovedView) {
  const Rigid3 camera_from_map(so3_exp({0.02, -0.03, 0.1}), {0.1, -0.05, 0.2});
  const Eigen::Vector3d in_camera = 2.5 * small_camera().ray({40, 71});
  MapPoints map;
  add_point(map, camera_from_map.inverse() * in_camera);
  for (const bool bilinear : {false, true}) {
    TemplateDrawer drawer(small_camera(), plain(bilinear), map);
    const auto point = find(drawer.draw(camera_from_map), 40, 71);
    ASSERT_TRUE(point);
    EXPECT_NEAR(point->value, 1, 1e-3);
    EXPECT_NEAR(point->inverse_depth, 1 / 2.5, 1e-5);
  }
}

TEST(EdgeTemplate, BilinearSplatsKeepTheSubPixelPosition) {
  const MapPoints map = one_point({40.25, 71.5}, 2);
  TemplateDrawer drawer(small_camera(), plain(true), map);
  static_cast<void>(drawer.draw({}));
  const PaddedImage& image = drawer.image();
  EXPECT_NEAR(image.row(71)[40], 0.375, 1e-3);
  EXPECT_NEAR(image.row(71)[41], 0.125, 1e-3);
  EXPECT_NEAR(image.row(72)[40], 0.375, 1e-3);
  EXPECT_NEAR(image.row(72)[41], 0.125, 1e-3);
}

TEST(EdgeTemplate, NearestSplatsRound) {
  const MapPoints map = one_point({40.4, 70.6}, 2);
  TemplateDrawer drawer(small_camera(), plain(false), map);
  static_cast<void>(drawer.draw({}));
  EXPECT_EQ(drawer.image().row(71)[40], 1);
  EXPECT_EQ(drawer.lit_pixels(), 1U);
}

TEST(EdgeTemplate, NearerOfTwoSurfacesHidesTheOther) {
  for (const bool near_first : {true, false})
    for (const bool bilinear : {false, true}) {
      MapPoints map = one_point({40.2, 71.1}, near_first ? 1 : 3);
      add_point(map, (near_first ? 3 : 1) * small_camera().ray({40.1, 71.2}));
      TemplateDrawer drawer(small_camera(), plain(bilinear), map);
      const auto point = find(drawer.draw({}), 40, 71);
      ASSERT_TRUE(point);
      EXPECT_NEAR(point->inverse_depth, 1, 1e-5);
    }
}

TEST(EdgeTemplate, WithoutTheTestBothSurfacesAreDrawn) {
  MapPoints map = one_point({40, 71}, 1);
  add_point(map, 3 * small_camera().ray({40, 71}));
  TemplateOptions options = plain(true);
  options.z_test = false;
  TemplateDrawer drawer(small_camera(), options, map);
  const auto point = find(drawer.draw({}), 40, 71);
  ASSERT_TRUE(point);
  EXPECT_NEAR(1 / point->inverse_depth, 2, 1e-4) << "the mean of 1 and 3 m";
}

TEST(EdgeTemplate, PointsOfOneSurfaceShareAPixel) {
  MapPoints map = one_point({40, 71}, 2);
  add_point(map, 2.02 * small_camera().ray({40, 71}));
  TemplateDrawer drawer(small_camera(), plain(true), map);
  const auto point = find(drawer.draw({}), 40, 71);
  ASSERT_TRUE(point);
  EXPECT_NEAR(point->value, 1, 1e-3) << "the mask stays a mask";
  EXPECT_NEAR(1 / point->inverse_depth, 2.01, 1e-4);
}

TEST(EdgeTemplate, DivisionRestoresTheDepthOfAPlane) {
  // 4.20 on outlines, so that the blur mixes lit and unlit pixels everywhere.
  for (const double slope : {0.0, 0.3}) {
    MapPoints map;
    for (int y = 5; y < 115; ++y)
      for (int x = 5; x < 155; ++x)
        if (x % 12 == 0 || y % 15 == 0) {
          const Eigen::Vector3d ray = small_camera().ray({x, y});
          add_point(map, ray * (2 / (1 - slope * ray.x())));  // z = 2 + slope * x
        }
    TemplateDrawer drawer(small_camera(), TemplateOptions{}, map);
    const auto points = drawer.draw({});
    ASSERT_GT(points.size(), 1000U);
    for (const TemplatePoint& p : points) {
      const double z = 2 / (1 - slope * static_cast<double>(p.ray.x()));
      // At most the blur's radius away from the pixel whose depth it got.
      const double radius = 2 * slope * z * z / 2 / small_camera().fx;
      EXPECT_NEAR(1 / p.inverse_depth, z, 1e-5 + radius);
    }
  }
}

TEST(EdgeTemplate, SlopeIsTheCentralDifferenceOfTheImage) {
  const MapPoints map = rectangle_map();
  const PinholeCamera camera = small_camera();
  TemplateDrawer drawer(camera, TemplateOptions{}, map);
  const auto points = drawer.draw({});
  const PaddedImage& image = drawer.image();
  ASSERT_GT(points.size(), 1000U);
  double steepest = 0;
  for (const TemplatePoint& p : points) {
    const Eigen::Vector2i u = pixel_of(p);
    const Eigen::Vector2d gradient((image.row(u.y())[u.x() + 1] - image.row(u.y())[u.x() - 1]) / 2,
                                   (image.row(u.y() + 1)[u.x()] - image.row(u.y() - 1)[u.x()]) / 2);
    EXPECT_NEAR(p.slope.x(), camera.fx * gradient.x(), 1e-4);
    EXPECT_NEAR(p.slope.y(), camera.fy * gradient.y(), 1e-4);
    EXPECT_EQ(p.value, image.row(u.y())[u.x()]);
    EXPECT_GT(p.value, 0);
    EXPECT_LE(p.value, 1 + 1e-6);
    EXPECT_GE(gradient.norm(), TemplateOptions{}.min_gradient_px - 1e-6);
    steepest = std::max(steepest, gradient.norm());
  }
  EXPECT_LT(steepest, 0.5) << "a blurred line of height one";
}

TEST(EdgeTemplate, ThresholdsSelectPointsButNotTheCountOfEvents) {
  const MapPoints map = rectangle_map();
  TemplateOptions options;
  TemplateDrawer steep(small_camera(), options, map);
  options.min_gradient_px = 0;
  TemplateDrawer all(small_camera(), options, map);
  const std::size_t steep_points = steep.draw({}).size();
  const std::size_t all_points = all.draw({}).size();
  EXPECT_LT(steep_points, all_points);
  EXPECT_EQ(all_points, all.lit_pixels());
  EXPECT_EQ(steep.lit_pixels(), all.lit_pixels()) << "n_map does not depend on the gradient";
  for (const TemplatePoint& p : all.draw({})) EXPECT_GT(p.value, kMinTemplateValue);
}

TEST(EdgeTemplate, PointsComeInRowMajorOrderWithoutTheBorder) {
  const MapPoints map = rectangle_map();
  const PinholeCamera camera = small_camera();
  TemplateDrawer drawer(camera, TemplateOptions{}, map);
  int last = -1;
  for (const TemplatePoint& p : drawer.draw({})) {
    const Eigen::Vector2i u = pixel_of(p);
    EXPECT_GT(u.y() * camera.width + u.x(), last);
    last = u.y() * camera.width + u.x();
    EXPECT_TRUE(u.x() > 0 && u.y() > 0 && u.x() < camera.width - 1 && u.y() < camera.height - 1);
  }
}

TEST(EdgeTemplate, WhatIsBehindTheCameraOrOutOfViewIsSkipped) {
  const PinholeCamera camera = small_camera();
  MapPoints map;
  add_point(map, -2 * camera.ray({80, 60}));  // its projection would lie in the middle
  add_point(map, Eigen::Vector3d(0.1, 0.1, 0));
  for (const double far : {-1e9, -200.0, 400.0, 1e9}) {
    add_point(map, 2 * camera.ray({far, 60}));
    add_point(map, 2 * camera.ray({80, far}));
  }
  for (const bool bilinear : {false, true}) {
    TemplateDrawer drawer(camera, plain(bilinear), map);
    EXPECT_TRUE(drawer.draw({}).empty());
    EXPECT_EQ(drawer.lit_pixels(), 0U);
  }
}

TEST(EdgeTemplate, LinesDoNotEndAtTheBorder) {
  // A vertical line that goes on beyond the view: its blurred value is the same in the first rows.
  MapPoints map;
  for (int y = -20; y < 140; ++y) add_point(map, 2 * small_camera().ray({80, y}));
  TemplateDrawer drawer(small_camera(), TemplateOptions{}, map);
  static_cast<void>(drawer.draw({}));
  EXPECT_NEAR(drawer.image().row(0)[80], drawer.image().row(60)[80], 1e-3);
  EXPECT_NEAR(drawer.image().row(119)[80], drawer.image().row(60)[80], 1e-3);
}

TEST(EdgeTemplate, ADrawDoesNotRememberTheLastOne) {
  const MapPoints map = rectangle_map();
  TemplateDrawer used(small_camera(), TemplateOptions{}, map);
  static_cast<void>(used.draw(Rigid3(so3_exp({0, 0, 1}), {0.3, 0, -0.5})));
  const std::span<const TemplatePoint> again = used.draw({});
  TemplateDrawer fresh(small_camera(), TemplateOptions{}, map);
  const std::span<const TemplatePoint> once = fresh.draw({});
  ASSERT_EQ(again.size(), once.size());
  for (std::size_t i = 0; i < once.size(); ++i) {
    EXPECT_EQ(again[i].value, once[i].value);
    EXPECT_EQ(again[i].inverse_depth, once[i].inverse_depth);
    EXPECT_EQ(again[i].slope, once[i].slope);
  }
}

TEST(EdgeTemplate, HalvedIsTheMeanOfFourPixelsWithTheirDepth) {
  PinholeCamera half = small_camera();
  half.width /= 2;
  half.height /= 2;
  MapPoints map;
  add_point(map, 2 * small_camera().ray({40, 70}));
  add_point(map, 4 * small_camera().ray({41, 71}));
  add_point(map, 3 * small_camera().ray({60, 21}));
  TemplateDrawer fine(small_camera(), plain(false), map);
  static_cast<void>(fine.draw({}));
  TemplateDrawer coarse(half, plain(false));
  EXPECT_EQ(coarse.draw_halved(fine).size(), 2U);
  EXPECT_NEAR(coarse.image().row(35)[20], 0.5, 1e-6);
  EXPECT_NEAR(coarse.image().row(10)[30], 0.25, 1e-6);
  EXPECT_NEAR(coarse.draw_halved(fine)[0].inverse_depth, 1.0 / 3, 1e-6) << "row-major: the upper";
  EXPECT_NEAR(coarse.draw_halved(fine)[1].inverse_depth, 1.0 / 3, 1e-6) << "mean of 2 and 4 m";
}

TEST(EdgeTemplate, AnEmptyMapGivesAnEmptyTemplate) {
  const MapPoints map;
  TemplateDrawer drawer(small_camera(), TemplateOptions{}, map);
  EXPECT_TRUE(drawer.draw({}).empty());
}

}  // namespace
}  // namespace saccade
