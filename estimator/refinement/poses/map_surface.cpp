#include "estimator/refinement/poses/map_surface.h"

#include <ceres/cubic_interpolation.h>

#include <cmath>
#include <limits>

namespace saccade {
namespace {

/// In the picture or about its size beside it.
bool is_near(const PinholeCamera& camera, const Eigen::Vector2d& pixel) {
  return std::abs(pixel.x()) < 2 * camera.width && std::abs(pixel.y()) < 2 * camera.height;
}

}  // namespace

SampleWithGradient<double> MapSurface::read(std::size_t view, const Eigen::Vector2d& pixel) const {
  using Grid = ceres::Grid2D<float>;
  const PinholeCamera& camera = map_.camera();
  const Grid grid(&map_.atlas()(0, map_.views()[view].first_row), 0, camera.height, 0,
                  camera.width);
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  SampleWithGradient<double> sample{kNaN, kNaN, kNaN};
  if (!is_near(camera, pixel)) return sample;
  ceres::BiCubicInterpolator<Grid>(grid).Evaluate(pixel.y(), pixel.x(), &sample.value, &sample.dy,
                                                  &sample.dx);
  return sample;
}

std::optional<ViewPlane> MapSurface::plane(std::size_t index, const Eigen::Vector2d& pixel) const {
  const PinholeCamera& camera = map_.camera();
  const IntensityMap::View& view = map_.views()[index];
  if (!(pixel.x() >= 1 && pixel.y() >= 1 && pixel.x() < camera.width - 2 &&
        pixel.y() < camera.height - 2))
    return std::nullopt;
  const int x = static_cast<int>(pixel.x());
  const int y = static_cast<int>(pixel.y());
  const auto at = [&](int u, int v) {
    return static_cast<std::size_t>(v) * static_cast<std::size_t>(camera.width) +
           static_cast<std::size_t>(u);
  };
  for (int v = y - 1; v <= y + 1; ++v)
    for (int u = x - 1; u <= x + 1; ++u)
      if (view.is_joined[at(u, v)] == 0) return std::nullopt;
  const auto inverse = [&](int u, int v) {
    return static_cast<double>(view.inverse_depth[at(u, v)]);
  };
  const double a = inverse(x, y), b = inverse(x + 1, y);
  const double c = inverse(x, y + 1), d = inverse(x + 1, y + 1);
  const double by_x = 0.5 * (b - a + d - c);
  const double by_y = 0.5 * (c - a + d - b);
  const double middle = 0.25 * (a + b + c + d);
  return ViewPlane(by_x * camera.fx, by_y * camera.fy,
                   middle + by_x * (camera.cx - x - 0.5) + by_y * (camera.cy - y - 0.5));
}

std::optional<MapSurface::Hit> MapSurface::intersect(const MapSample& seen,
                                                     const Rigid3& map_from_camera,
                                                     const Eigen::Vector3d& ray) const {
  // On a plane the first is exact; a curved surface is met closely enough by the second.
  constexpr int kSteps = 2;
  if (!(seen.inverse_depth > 0)) return std::nullopt;
  const int rows = map_.camera().height + 1;
  Hit hit;
  hit.view = static_cast<std::size_t>(seen.atlas_px.y()) / static_cast<std::size_t>(rows);
  const IntensityMap::View& view = map_.views()[hit.view];
  hit.pixel = seen.atlas_px.cast<double>() - Eigen::Vector2d(0, view.first_row);
  const Rigid3 view_from_camera = view.view_from_map * map_from_camera;
  for (int i = 0; i < kSteps; ++i) {
    const std::optional<ViewPlane> touching = plane(hit.view, hit.pixel);
    if (!touching) return std::nullopt;
    hit.plane = *touching;
    const PlaneReprojection reprojection =
        reproject_on_plane(map_.camera(), view_from_camera, ray, hit.plane);
    if (!reprojection.is_valid) return std::nullopt;
    hit.pixel = reprojection.pixel;
  }
  if (!plane(hit.view, hit.pixel)) return std::nullopt;
  return hit;
}

}  // namespace saccade
