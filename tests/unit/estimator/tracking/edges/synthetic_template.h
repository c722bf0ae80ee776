#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <span>

#include "core/camera.h"
#include "core/event.h"
#include "core/random.h"
#include "core/rigid3.h"
#include "estimator/tracking/edges/edge_template.h"
#include "estimator/tracking/edges/event_frame.h"
#include "estimator/tracking/map_extraction.h"

namespace saccade::testing {

inline PinholeCamera small_camera() {
  PinholeCamera camera;
  camera.width = 160;
  camera.height = 120;
  camera.fx = 134;
  camera.fy = 131;
  camera.cx = 80.3;
  camera.cy = 58.7;
  return camera;
}

inline void add_point(MapPoints& map, const Eigen::Vector3d& point) {
  map.x.push_back(static_cast<float>(point.x()));
  map.y.push_back(static_cast<float>(point.y()));
  map.z.push_back(static_cast<float>(point.z()));
}

/// Outlines of turned rectangles at depths of 1.5..3.5 m all over the view of small_camera() and
/// a little beyond: edges in every direction, parallax between them.
inline MapPoints rectangle_map() {
  const PinholeCamera camera = small_camera();
  const Random random(11);
  MapPoints map;
  for (std::uint64_t i = 0; i < 36; ++i) {
    const Eigen::Vector2d centre(-10 + (camera.width + 20) * random.uniform(0, i),
                                 -10 + (camera.height + 20) * random.uniform(1, i));
    const double depth = 1.5 + 2 * random.uniform(2, i);
    const double angle = 3 * random.uniform(3, i);
    const Eigen::Vector2d along(std::cos(angle), std::sin(angle));
    const Eigen::Vector2d across(-along.y(), along.x());
    constexpr int kHalf = 9;  // px
    for (int k = -kHalf; k <= kHalf; ++k)
      for (const double side : {-1.0, 1.0}) {
        add_point(map, depth * camera.ray(centre + k * along + side * kHalf * across));
        add_point(map, depth * camera.ray(centre + side * kHalf * along + k * across));
      }
  }
  return map;
}

/// An event in every pixel with probability `gain` * T + `offset`, T being the map's template in
/// the given view.
inline EventFrame random_frame(const MapPoints& map, const Rigid3& camera_from_map, double gain,
                               double offset, std::uint64_t seed) {
  const PinholeCamera camera = small_camera();
  TemplateDrawer drawer(camera, {}, map);
  static_cast<void>(drawer.draw(camera_from_map));
  const Random random(seed);
  Events events;
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x)
      if (random.uniform(static_cast<std::uint64_t>(y), static_cast<std::uint64_t>(x)) <
          gain * static_cast<double>(drawer.image().row(y)[x]) + offset)
        events.push_back({0, static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y), 1});
  EventFrame frame(camera);
  frame.draw(events);
  return frame;
}

/// RMS distance [px] between the template's points under two poses.
inline double pixels_between(std::span<const TemplatePoint> points, const Rigid3& a,
                             const Rigid3& b) {
  const PinholeCamera camera = small_camera();
  double squared = 0;
  for (const TemplatePoint& p : points) {
    const Eigen::Vector3d point = Eigen::Vector3d(p.ray.x(), p.ray.y(), 1) / p.inverse_depth;
    squared += (camera.project(a * point) - camera.project(b * point)).squaredNorm();
  }
  return std::sqrt(squared / static_cast<double>(points.size()));
}

}  // namespace saccade::testing
