#include "estimator/refinement/poses/map_surface.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/estimator/refinement/poses/corner_view.h"

namespace saccade {
namespace {

using testing::corner_view;
using testing::CornerView;

TEST(MapSurface, ReadsThePictureAndItsSlope) {
  const MapSurface surface(corner_view().map);
  const ImageF& atlas = corner_view().map.atlas();
  EXPECT_NEAR(surface.read(0, {33, 41}).value, static_cast<double>(atlas(33, 41)), 1e-6);
  const Eigen::Vector2d at(33.4, 40.7);
  constexpr double kStep = 1e-5;
  const auto along = [&](double x, double y) {
    return surface.read(0, at + kStep * Eigen::Vector2d(x, y)).value;
  };
  const auto seen = surface.read(0, at);
  EXPECT_NEAR(seen.dx, (along(1, 0) - along(-1, 0)) / (2 * kStep), 1e-6);
  EXPECT_NEAR(seen.dy, (along(0, 1) - along(0, -1)) / (2 * kStep), 1e-6);
  EXPECT_TRUE(std::isnan(surface.read(0, {1e9, 0}).value));
}

TEST(MapSurface, ARayMeetsTheSurfaceThatItsPixelSees) {
  const MapSurface surface(corner_view().map);
  const Rigid3 map_from_camera = CornerView::motion(0).inverse() * CornerView::motion(0.2);
  const ImageF depth = corner_view().world.depth(CornerView::motion(0.2));
  const PinholeCamera& camera = corner_view().world.camera();
  MapView view(corner_view().map, 1);
  view.draw(map_from_camera);
  int hits = 0, exact = 0;
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x) {
      const auto hit = surface.intersect(view(x, y), map_from_camera, camera.ray({x, y}));
      if (!hit) continue;
      ++hits;
      const double z = 1 / hit->plane.dot(camera.ray(hit->pixel));
      const Eigen::Vector3d in_camera =
          map_from_camera.inverse() * Eigen::Vector3d(z * camera.ray(hit->pixel));
      const double error = std::abs(static_cast<double>(depth(x, y)) / in_camera.z() - 1);
      // Not so where a square lies over the fold between the walls, and beside the nearer plane.
      if (error < 1e-4) ++exact;
    }
  EXPECT_GT(exact, 0.95 * hits);
  EXPECT_GT(hits, camera.width * camera.height / 2);
}

TEST(MapSurface, NothingIsMetBesideAnOccludingEdge) {
  const MapSurface surface(corner_view().map);
  const IntensityMap::View& view = corner_view().map.views()[0];
  const PinholeCamera& camera = corner_view().world.camera();
  int edges = 0;
  for (int y = 3; y < camera.height - 3; ++y)
    for (int x = 3; x < camera.width - 3; ++x)
      if (view.is_joined[static_cast<std::size_t>(y * camera.width + x)] == 0) {
        ++edges;
        EXPECT_FALSE(surface.plane(0, {x + 0.5, y + 0.5}));
        EXPECT_FALSE(surface.plane(0, {x - 0.5, y + 1.5}));
      }
  EXPECT_GT(edges, 20);
}

}  // namespace
}  // namespace saccade
