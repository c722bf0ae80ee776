#include "eval/picture/image/map_picture.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "eval/picture/canvas/canvas.h"
#include "eval/picture/image/event_picture.h"

namespace saccade {
namespace {

/// Pixels (u, v) and depths [m] of the points inside the image.
std::vector<Eigen::Vector3d> project_inside(std::span<const Eigen::Vector3f> points_in_world,
                                            const Rigid3& world_from_camera,
                                            const PinholeCamera& camera) {
  const Rigid3 camera_from_world = world_from_camera.inverse();
  std::vector<Eigen::Vector3d> inside;
  for (const Eigen::Vector3f& point : points_in_world) {
    const Eigen::Vector3d in_camera = camera_from_world * point.cast<double>();
    if (!(in_camera.z() > 0)) continue;
    const Eigen::Vector2d pixel = camera.project(in_camera);
    if (camera.contains(pixel)) inside.emplace_back(pixel.x(), pixel.y(), in_camera.z());
  }
  return inside;
}

bool is_dark(const Theme& theme) { return theme.background[0] < 128; }

/// Adds light on a dark background, multiplies like ink on a light one.
void blend(Rgb8& pixel, const Rgb8& colour, bool dark) {
  for (std::size_t i = 0; i < 3; ++i) {
    const int value = dark ? std::min(255, pixel[i] + colour[i]) : pixel[i] * colour[i] / 255;
    pixel[i] = static_cast<std::uint8_t>(value);
  }
}

}  // namespace

std::vector<Eigen::Vector2d> visible_points(std::span<const Eigen::Vector3f> points_in_world,
                                            const Rigid3& world_from_camera,
                                            const PinholeCamera& camera) {
  constexpr double kBehind = 1.05;
  const std::vector<Eigen::Vector3d> inside =
      project_inside(points_in_world, world_from_camera, camera);
  ImageF nearest(camera.width, camera.height, std::numeric_limits<float>::infinity());
  const auto for_each_cell = [&](const Eigen::Vector3d& p, const auto& body) {
    const int x = static_cast<int>(std::lround(p.x()));
    const int y = static_cast<int>(std::lround(p.y()));
    for (int row = std::max(0, y - 1); row <= std::min(camera.height - 1, y + 1); ++row)
      for (int column = std::max(0, x - 1); column <= std::min(camera.width - 1, x + 1); ++column)
        body(nearest(column, row));
  };
  for (const Eigen::Vector3d& p : inside)
    for_each_cell(p, [&](float& z) { z = std::min(z, static_cast<float>(p.z())); });
  std::vector<Eigen::Vector2d> visible;
  for (const Eigen::Vector3d& p : inside) {
    const int x = static_cast<int>(std::lround(p.x()));
    const int y = static_cast<int>(std::lround(p.y()));
    if (p.z() <= kBehind * static_cast<double>(nearest(x, y))) visible.emplace_back(p.head<2>());
  }
  return visible;
}

ImageRgb8 draw_map_over_events(std::span<const Event> events,
                               std::span<const Eigen::Vector2d> map_pixels,
                               const PinholeCamera& camera, int upscale_factor,
                               const Theme& theme) {
  const bool dark = is_dark(theme);
  ImageRgb8 picture =
      upscale(draw_events(events, camera.width, camera.height, theme), upscale_factor);
  const int size = std::max(1, upscale_factor - 1);
  Image<std::uint8_t> covered(picture.width(), picture.height());
  for (const Eigen::Vector2d& pixel : map_pixels) {
    // A little less than a sensor pixel, so that single points and the events between them show;
    // sensor pixel (0, 0) starts at screen pixel 0.
    const auto left = static_cast<int>(std::lround(pixel.x() * upscale_factor));
    const auto top = static_cast<int>(std::lround(pixel.y() * upscale_factor));
    for (int y = std::max(0, top); y < std::min(picture.height(), top + size); ++y)
      for (int x = std::max(0, left); x < std::min(picture.width(), left + size); ++x)
        covered(x, y) = 1;
  }
  for (std::size_t i = 0; i < covered.size(); ++i)
    if (covered.pixels()[i] != 0) blend(picture.pixels()[i], theme.map, dark);
  return picture;
}

}  // namespace saccade
