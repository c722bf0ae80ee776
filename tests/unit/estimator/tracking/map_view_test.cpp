#include "estimator/tracking/map_view.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace saccade {
namespace {

constexpr int kWidth = 80;
constexpr int kHeight = 60;
constexpr int kMargin = 6;
/// The nearer plane, in pixels of the view that the map is made of.
constexpr int kLeft = 30, kRight = 50, kTop = 20, kBottom = 42;
constexpr float kNear_m = 1.5F, kFar_m = 3;

PinholeCamera two_planes_camera() {
  PinholeCamera camera;
  camera.width = kWidth;
  camera.height = kHeight;
  camera.fx = 70;
  camera.fy = 68;
  camera.cx = 39.2;
  camera.cy = 29.9;
  return camera;
}

bool is_near(double x, double y, double room) {
  return x > kLeft + room && x < kRight - room && y > kTop + room && y < kBottom - room;
}

/// A small plane before a large one, both parallel to the image.
IntensityMap two_planes() {
  ReferenceView view{ImageF(kWidth, kHeight, -1), ImageF(kWidth, kHeight, kFar_m), {}};
  for (int y = kTop; y <= kBottom; ++y)
    for (int x = kLeft; x <= kRight; ++x) view.depth(x, y) = kNear_m;
  return {two_planes_camera(), std::span(&view, 1), 0};
}

/// A step to the side that opens a gap of some pixels, and a small turn.
Rigid3 beside() { return {so3_exp({0.01, -0.02, 0.03}), {0.3, -0.1, 0.04}}; }

MapView view_of(const IntensityMap& map, const Rigid3& map_from_camera) {
  MapView view(map, kMargin);
  view.draw(map_from_camera);
  return view;
}

template <class Function>
void for_every_pixel(int margin, const Function& function) {
  for (int y = -margin; y < kHeight + margin; ++y)
    for (int x = -margin; x < kWidth + margin; ++x) function(x, y);
}

TEST(MapView, PointsAndPlacesAreThoseThatThePixelsSee) {
  const IntensityMap map = two_planes();
  const MapView view = view_of(map, beside());
  int seen_pixels = 0;
  for_every_pixel(kMargin, [&](int x, int y) {
    const MapSample& seen = view(x, y);
    if (!(seen.inverse_depth > 0)) return;
    ++seen_pixels;
    const Eigen::Vector3d point = seen.point.cast<double>();
    const Eigen::Vector3d in_camera = beside().inverse() * point;
    EXPECT_LT((two_planes_camera().project(in_camera) - Eigen::Vector2d(x, y)).norm(), 0.02);
    EXPECT_LT((two_planes_camera().project(point) - seen.atlas_px.cast<double>()).norm(), 0.02);
    EXPECT_NEAR(1 / in_camera.z(), static_cast<double>(seen.inverse_depth), 1e-4);
    EXPECT_NEAR(point.z(), is_near(seen.atlas_px.x(), seen.atlas_px.y(), -0.5) ? kNear_m : kFar_m,
                1e-4);
  });
  EXPECT_GT(seen_pixels, kWidth * kHeight * 7 / 10);
}

/// What a pixel sees by the geometry of the two planes.
enum class Truth { kNear, kFar, kGap, kBorder };

Truth truth_at(int x, int y, const Rigid3& map_from_camera) {
  const Eigen::Vector3d ray = map_from_camera.rotation_matrix() * two_planes_camera().ray({x, y});
  const Eigen::Vector3d& eye = map_from_camera.translation();
  const auto at = [&](float depth_m) -> Eigen::Vector2d {
    const double along = (static_cast<double>(depth_m) - eye.z()) / ray.z();
    return two_planes_camera().project(eye + along * ray);
  };
  // Within a pixel of an outline either is right.
  constexpr double kRoom = 1.1;
  const Eigen::Vector2d near = at(kNear_m);
  const Eigen::Vector2d far = at(kFar_m);
  if (is_near(near.x(), near.y(), kRoom)) return Truth::kNear;
  if (is_near(near.x(), near.y(), -kRoom)) return Truth::kBorder;
  if (is_near(far.x(), far.y(), kRoom)) return Truth::kGap;
  if (is_near(far.x(), far.y(), -kRoom)) return Truth::kBorder;
  const bool is_in_view =
      far.x() > 0.1 && far.y() > 0.1 && far.x() < kWidth - 1.1 && far.y() < kHeight - 1.1;
  return is_in_view ? Truth::kFar : Truth::kBorder;
}

TEST(MapView, ACoarseViewSeesAtItsNodesWhatAFineOneSees) {
  const IntensityMap map = two_planes();
  const MapView fine = view_of(map, beside());
  for (const int step : {2, 3}) {
    MapView coarse(map, 2, step);
    coarse.draw(beside());
    EXPECT_EQ(coarse.node_at({10.4F * static_cast<float>(step), 0}), Eigen::Vector2i(10, 0));
    int seen_nodes = 0;
    for (int y = 0; y * step < kHeight; ++y)
      for (int x = 0; x * step < kWidth; ++x) {
        const MapSample& node = coarse(x, y);
        const MapSample& pixel = fine(x * step, y * step);
        if (!(node.inverse_depth > 0)) continue;
        if (truth_at(x * step, y * step, beside()) == Truth::kBorder) continue;
        ++seen_nodes;
        EXPECT_NEAR(node.inverse_depth, pixel.inverse_depth, 1e-5) << x << " " << y;
        EXPECT_LT((node.point - pixel.point).norm(), 1e-3) << x << " " << y;
        EXPECT_LT((node.atlas_px - pixel.atlas_px).norm(), 5e-3) << x << " " << y;
        EXPECT_LT((node.atlas_per_pixel - pixel.atlas_per_pixel).norm(), 5e-3) << x << " " << y;
      }
    EXPECT_GT(seen_nodes, kWidth * kHeight / (step * step) / 2);
  }
}

TEST(MapView, TheNearerPlaneHidesTheFartherAndTheGapIsUnknown) {
  const IntensityMap map = two_planes();
  const MapView view = view_of(map, beside());
  int gap = 0;
  int hidden = 0;
  for_every_pixel(0, [&](int x, int y) {
    const MapSample& seen = view(x, y);
    switch (truth_at(x, y, beside())) {
      case Truth::kNear:
        EXPECT_GT(seen.inverse_depth, 0.5F) << x << " " << y;
        hidden += is_near(x, y, 0) ? 0 : 1;  // which showed the farther plane before
        break;
      case Truth::kFar:
        EXPECT_GT(seen.inverse_depth, 0) << x << " " << y;
        EXPECT_LT(seen.inverse_depth, 0.5F) << x << " " << y;
        break;
      case Truth::kGap:
        EXPECT_EQ(seen.inverse_depth, 0) << x << " " << y;
        ++gap;
        break;
      case Truth::kBorder:
        break;
    }
  });
  EXPECT_GT(gap, 30);
  EXPECT_GT(hidden, 30);
}

TEST(MapView, ScaleIsHowPlacesDifferBetweenNeighbours) {
  const IntensityMap map = two_planes();
  const MapView view = view_of(map, beside());
  int compared = 0;
  for_every_pixel(kMargin - 1, [&](int x, int y) {
    const MapSample& seen = view(x, y);
    const auto difference = [&](int dx, int dy, int column) {
      const MapSample& before = view(x - dx, y - dy);
      const MapSample& after = view(x + dx, y + dy);
      const auto goes_on = [&](const MapSample& other) {
        return std::abs(other.inverse_depth - seen.inverse_depth) < 0.05F;
      };
      if (!(seen.inverse_depth > 0) || !goes_on(before) || !goes_on(after)) return;
      EXPECT_LT((seen.atlas_per_pixel.col(column) - (after.atlas_px - before.atlas_px) / 2).norm(),
                0.01F);
      ++compared;
    };
    difference(1, 0, 0);
    difference(0, 1, 1);
  });
  EXPECT_GT(compared, kWidth * kHeight);
}

TEST(MapView, AtTheViewOfTheMapEveryPixelSeesItself) {
  const IntensityMap map = two_planes();
  const MapView view = view_of(map, {});
  for_every_pixel(0, [&](int x, int y) {
    const MapSample& seen = view(x, y);
    if (!(seen.inverse_depth > 0)) return;
    EXPECT_LT(
        (seen.atlas_px - Eigen::Vector2f(static_cast<float>(x), static_cast<float>(y))).norm(),
        1e-3F);
    EXPECT_LT((seen.atlas_per_pixel - Eigen::Matrix2f::Identity()).norm(), 1e-3F);
  });
  EXPECT_GT(view.coverage(), 0.9);
  EXPECT_FALSE(view(-1, 5).inverse_depth > 0) << "nothing is known of the margin";
  EXPECT_GT(view.typical_depth_m(), kNear_m);
  EXPECT_LT(view.typical_depth_m(), kFar_m);
}

TEST(MapView, ContainsTheImageAndTheMarginAroundIt) {
  const IntensityMap map = two_planes();
  const MapView view(map, kMargin);
  EXPECT_TRUE(view.contains(-kMargin, -kMargin));
  EXPECT_TRUE(view.contains(kWidth + kMargin - 1, kHeight + kMargin - 1));
  EXPECT_FALSE(view.contains(-kMargin - 1, 0));
  EXPECT_FALSE(view.contains(0, kHeight + kMargin));
}

TEST(MapView, NothingBehindTheCameraIsSeen) {
  const IntensityMap map = two_planes();
  const MapView turned = view_of(map, {so3_exp({0, std::numbers::pi, 0}), {0, 0, 0}});
  for_every_pixel(kMargin, [&](int x, int y) { EXPECT_EQ(turned(x, y).inverse_depth, 0); });
  EXPECT_EQ(turned.coverage(), 0);
  EXPECT_EQ(turned.typical_depth_m(), 1);
  // Between the planes the nearer one is behind, and hides nothing.
  const MapView between = view_of(map, {{1, 0, 0, 0}, {0.2, 0, 2}});
  EXPECT_GT(between.coverage(), 0);
  for_every_pixel(kMargin, [&](int x, int y) {
    if (between(x, y).inverse_depth > 0) {
      EXPECT_NEAR(between(x, y).inverse_depth, 1, 1e-4);
    }
  });
}

TEST(MapView, DrawingAgainForgetsTheLastView) {
  const IntensityMap map = two_planes();
  MapView view(map, kMargin);
  view.draw({});
  view.draw(beside());
  const MapView fresh = view_of(map, beside());
  EXPECT_EQ(view.coverage(), fresh.coverage());
  for_every_pixel(kMargin, [&](int x, int y) {
    EXPECT_EQ(view(x, y).inverse_depth, fresh(x, y).inverse_depth);
    if (fresh(x, y).inverse_depth > 0) {
      EXPECT_EQ(view(x, y).atlas_px, fresh(x, y).atlas_px);
    }
  });
}

/// Views of one distant surface, turned about the upright axis.
IntensityMap turned_views(const std::vector<double>& angles) {
  std::vector<ReferenceView> views;
  for (const double angle : angles) {
    ReferenceView view{ImageF(kWidth, kHeight, -1), ImageF(kWidth, kHeight), {}};
    // A ball around the eye, so that all views show the same points.
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x)
        view.depth(x, y) = static_cast<float>(4 / two_planes_camera().ray({x, y}).norm());
    view.world_from_reference = {so3_exp({0, angle, 0}), {0, 0, 0}};
    views.push_back(view);
  }
  return {two_planes_camera(), views, 0};
}

/// Which view the place belongs to; -1: none.
int view_at(const MapView& view, int x, int y) {
  const MapSample& seen = view(x, y);
  return seen.inverse_depth > 0 ? static_cast<int>(seen.atlas_px.y() + 0.5F) / (kHeight + 1) : -1;
}

TEST(MapView, TheViewNearestInAngleIsShownWhereItCan) {
  const IntensityMap map = turned_views({0, 0.3});
  const MapView near_first = view_of(map, {so3_exp({0, 0.1, 0}), {0, 0, 0}});
  const MapView near_second = view_of(map, {so3_exp({0, 0.2, 0}), {0, 0, 0}});
  EXPECT_EQ(view_at(near_first, 40, 30), 0);
  EXPECT_EQ(view_at(near_second, 40, 30), 1);
  // Beyond the first view's border the second one goes on.
  EXPECT_EQ(view_at(near_first, kWidth - 3, 30), 1);
  EXPECT_EQ(view_at(near_second, 2, 30), 0);
}

TEST(MapView, PlacesInFurtherViewsAreWhereThoseShowThePoint) {
  const IntensityMap map = turned_views({0, 0.3});
  const Rigid3 pose(so3_exp({0, 0.2, 0}), {0.02, 0, 0});
  const MapView view = view_of(map, pose);
  int compared = 0;
  for_every_pixel(0, [&](int x, int y) {
    const int shown_by = view_at(view, x, y);
    if (shown_by < 0) return;
    const MapSample& seen = view(x, y);
    const IntensityMap::View& of = map.views()[static_cast<std::size_t>(shown_by)];
    const Eigen::Vector2d in_view =
        two_planes_camera().project(of.view_from_map * seen.point.cast<double>());
    EXPECT_LT((in_view + Eigen::Vector2d(0, of.first_row) - seen.atlas_px.cast<double>()).norm(),
              0.02);
    const Eigen::Vector3d in_camera = pose.inverse() * seen.point.cast<double>();
    EXPECT_LT((two_planes_camera().project(in_camera) - Eigen::Vector2d(x, y)).norm(), 0.02);
    compared += shown_by;
  });
  EXPECT_GT(compared, 1000);
}

TEST(MapView, OnlyTheThreeNearestViewsAreDrawn) {
  const IntensityMap map = turned_views({0.9, 0, 0.3, 0.6});
  // The map's frame is that of the first view: this looks where the second one does.
  const MapView view = view_of(map, {so3_exp({0, -0.9, 0}), {0, 0, 0}});
  bool is_shown[4] = {};
  for_every_pixel(kMargin, [&](int x, int y) {
    if (view_at(view, x, y) >= 0) is_shown[view_at(view, x, y)] = true;
  });
  EXPECT_TRUE(is_shown[1]);
  EXPECT_TRUE(is_shown[2]);
  EXPECT_FALSE(is_shown[0]);
}

}  // namespace
}  // namespace saccade
