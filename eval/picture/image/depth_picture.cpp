#include "eval/picture/image/depth_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "eval/picture/canvas/canvas.h"
#include "eval/picture/canvas/colour_bar.h"
#include "eval/picture/canvas/scale_bar.h"

namespace saccade {
namespace {

ImageRgb8 empty_picture(const PinholeCamera& camera, int upscale, const Theme& theme) {
  return {camera.width * upscale, camera.height * upscale, theme.faint};
}

/// A single pixel would hardly be visible.
void draw_square(ImageRgb8& picture, const Eigen::Vector2d& pixel, int upscale,
                 const Rgb8& colour) {
  const int size = 2 * upscale - 1;
  const auto x = static_cast<int>(std::lround((pixel.x() + 0.5) * upscale - 0.5)) - size / 2;
  const auto y = static_cast<int>(std::lround((pixel.y() + 0.5) * upscale - 0.5)) - size / 2;
  for (int v = std::max(y, 0); v < std::min(y + size, picture.height()); ++v)
    for (int u = std::max(x, 0); u < std::min(x + size, picture.width()); ++u)
      picture(u, v) = colour;
}

/// Without the dark end of the colours, which is invisible on a dark background.
Rgb8 error_colour(double fraction) { return ordered_colour(0.3 + 0.7 * std::min(fraction, 1.0)); }

/// The 1st and the 99th percentile.
std::pair<double, double> percentile_range(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t cut = values.size() / 100;
  return {values[cut], values[values.size() - 1 - cut]};
}

}  // namespace

DepthRange depth_range(std::span<const DepthPoint> points) {
  ImageF depths(static_cast<int>(points.size()), 1);
  for (std::size_t i = 0; i < points.size(); ++i)
    depths.pixels()[i] = static_cast<float>(points[i].depth_m);
  return depth_range(depths);
}

ImageRgb8 draw_depth_points(std::span<const DepthPoint> points, const PinholeCamera& camera,
                            const DepthRange& range, int upscale, const Theme& theme) {
  ImageRgb8 picture = empty_picture(camera, upscale, theme);
  for (const DepthPoint& point : points)
    draw_square(picture, point.pixel, upscale, depth_colour(point.depth_m, range));
  return with_depth_bar(std::move(picture), range);
}

ImageRgb8 draw_depth_map(const ImageF& depth, const DepthRange& range, int factor,
                         const Theme& theme) {
  return with_depth_bar(upscale(draw_depth(depth, range, theme), factor), range);
}

ImageRgb8 draw_depth_errors(const DepthErrors& errors, const PinholeCamera& camera,
                            double max_relative, int upscale, const Theme& theme) {
  ImageRgb8 picture = empty_picture(camera, upscale, theme);
  for (std::size_t i = 0; i < errors.scored.size(); ++i)
    draw_square(picture, errors.scored[i].pixel, upscale,
                error_colour(errors.best[i].relative / max_relative));
  return with_colour_bar(std::move(picture), error_colour, "0 %",
                         fmt::format("{:.3g} %", 100 * max_relative));
}

ImageRgb8 draw_top_down(std::span<const Eigen::Vector3d> points, int width, int height,
                        const Theme& theme) {
  ImageRgb8 picture(width, height, theme.background);
  if (points.empty()) return picture;
  std::vector<double> x, z;
  for (const Eigen::Vector3d& point : points) {
    x.push_back(point.x());
    z.push_back(point.z());
  }
  const auto [left, right] = percentile_range(x);
  const auto [low, high] = percentile_range(z);
  constexpr double kMargin = 0.06;
  const double extent_x = std::max(right - left, 1e-6);
  const double extent_z = std::max(high - low, 1e-6);
  const double scale = (1 - 2 * kMargin) * std::min(width / extent_x, height / extent_z);  // [px/m]
  for (const Eigen::Vector3d& point : points) {
    const double u = width / 2.0 + scale * (point.x() - (left + right) / 2);
    const double v = height / 2.0 - scale * (point.z() - (low + high) / 2);
    if (u >= 0 && v >= 0 && u < width && v < height)
      picture(static_cast<int>(u), static_cast<int>(v)) = theme.estimate;
  }
  Canvas canvas(std::move(picture));
  draw_scale_bar(canvas, scale, theme);
  return canvas.image();
}

}  // namespace saccade
