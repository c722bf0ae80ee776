#include "estimator/tracking/map_extraction.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "core/check.h"

namespace saccade {
namespace {

/// Central differences [1/px]; 0 on the border and beside NaN pixels.
void differentiate(const ImageF& image, ImageF& gradient_x, ImageF& gradient_y) {
  gradient_x = gradient_y = ImageF(image.width(), image.height());
  for (int v = 1; v + 1 < image.height(); ++v)
    for (int u = 1; u + 1 < image.width(); ++u) {
      const float gx = (image(u + 1, v) - image(u - 1, v)) / 2;
      const float gy = (image(u, v + 1) - image(u, v - 1)) / 2;
      if (!std::isfinite(gx) || !std::isfinite(gy)) continue;
      gradient_x(u, v) = gx;
      gradient_y(u, v) = gy;
    }
}

ImageF magnitude_of(const ImageF& gradient_x, const ImageF& gradient_y) {
  ImageF magnitude(gradient_x.width(), gradient_x.height());
  for (int y = 1; y + 1 < magnitude.height(); ++y)
    for (int x = 1; x + 1 < magnitude.width(); ++x)
      magnitude(x, y) =
          std::sqrt(gradient_x(x, y) * gradient_x(x, y) + gradient_y(x, y) * gradient_y(x, y));
  return magnitude;
}

/// True unless a neighbour across the edge, one pixel along the gradient, is steeper.
bool is_ridge(const ImageF& magnitude, const ImageF& gradient_x, const ImageF& gradient_y, int x,
              int y) {
  const float here = magnitude(x, y);
  const float dx = gradient_x(x, y) / here;
  const float dy = gradient_y(x, y) / here;
  const auto fx = static_cast<float>(x);
  const auto fy = static_cast<float>(y);
  // >= on one side only, so that a tie keeps exactly one of two equal neighbours.
  return here >= sample(magnitude, fx + dx, fy + dy) && here > sample(magnitude, fx - dx, fy - dy);
}

/// Nearest valid depth in the 3 x 3 neighbourhood, as long as it belongs to another surface;
/// 0 when the pixel itself has none and no neighbour has.
float foreground_depth(const ImageF& depth, int x, int y) {
  float nearest = 0;
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx) {
      const float d = depth(x + dx, y + dy);
      if (d > 0 && (nearest == 0 || d < nearest)) nearest = d;
    }
  // On one slanted surface neighbours differ by little, and the pixel's own depth is the exact one.
  constexpr float kStep = 0.9F;
  const float own = depth(x, y);
  return own > 0 && nearest > kStep * own ? own : nearest;
}

/// g_min as a gradient [1/px]: raised, where it must be, until `max_fraction` of the pixels lie
/// above it.
float gradient_threshold(const ImageF& magnitude, float largest, const MapOptions& options) {
  const float threshold = static_cast<float>(options.min_gradient) * largest;
  const auto most =
      static_cast<std::size_t>(options.max_fraction * static_cast<double>(magnitude.size()));
  if (most >= magnitude.size()) return threshold;
  std::vector<float> sorted(magnitude.pixels().begin(), magnitude.pixels().end());
  const auto last = sorted.begin() + static_cast<std::ptrdiff_t>(most);
  std::nth_element(sorted.begin(), last, sorted.end(), std::greater<>());
  return std::max(threshold, *last);
}

}  // namespace

void append(MapPoints& all, const MapPoints& more) {
  all.x.insert(all.x.end(), more.x.begin(), more.x.end());
  all.y.insert(all.y.end(), more.y.begin(), more.y.end());
  all.z.insert(all.z.end(), more.z.begin(), more.z.end());
}

MapPoints transformed(const Rigid3& target_from_source, const MapPoints& points) {
  MapPoints moved;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d point =
        target_from_source * Eigen::Vector3d(points.x[i], points.y[i], points.z[i]);
    moved.x.push_back(static_cast<float>(point.x()));
    moved.y.push_back(static_cast<float>(point.y()));
    moved.z.push_back(static_cast<float>(point.z()));
  }
  return moved;
}

MapPoints extract_map(const ImageF& log_intensity, const ImageF& depth, const PinholeCamera& camera,
                      const MapOptions& options) {
  ImageF gradient_x, gradient_y;
  differentiate(log_intensity, gradient_x, gradient_y);
  return lift_edges(gradient_x, gradient_y, depth, camera, options);
}

MapPoints lift_edges(const ImageF& gradient_x, const ImageF& gradient_y, const ImageF& depth,
                     const PinholeCamera& camera, const MapOptions& options) {
  SACCADE_CHECK(gradient_x.width() == depth.width() && gradient_x.height() == depth.height());
  const ImageF magnitude = magnitude_of(gradient_x, gradient_y);
  float largest = 0;
  for (const float g : magnitude.pixels()) largest = std::max(largest, g);
  const float threshold = gradient_threshold(magnitude, largest, options);
  MapPoints map;
  for (int y = 1; y + 1 < depth.height(); ++y)
    for (int x = 1; x + 1 < depth.width(); ++x) {
      if (!(magnitude(x, y) > threshold)) continue;
      if (options.thin && !is_ridge(magnitude, gradient_x, gradient_y, x, y)) continue;
      const float z = options.foreground_depth ? foreground_depth(depth, x, y) : depth(x, y);
      if (!(z > 0)) continue;
      const Eigen::Vector3d ray = camera.ray({x, y});
      map.x.push_back(static_cast<float>(ray.x()) * z);
      map.y.push_back(static_cast<float>(ray.y()) * z);
      map.z.push_back(z);
    }
  return map;
}

}  // namespace saccade
