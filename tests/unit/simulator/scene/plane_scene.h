#pragma once

#include <utility>

#include "simulator/scene/scene_builder.h"
#include "simulator/sensor/event_options.h"
#include "tests/support/closed_form_plane.h"
#include "tests/support/meshes.h"

namespace saccade::testing {

inline Scene scene_of(const std::vector<Mesh>& meshes) {
  SceneBuilder builder;
  for (const Mesh& mesh : meshes) builder.add(mesh, Eigen::Affine3d::Identity());
  return std::move(builder).build(Background(0.5));
}

inline Scene scene_of(const ClosedFormPlane& plane) {
  const Eigen::Vector2d size =
      plane.metres_per_texel * Eigen::Vector2d(plane.texture.width(), plane.texture.height());
  return scene_of({rectangle({-0.5 * size.x(), -0.5 * size.y(), plane.distance_m}, {size.x(), 0, 0},
                             {0, size.y(), 0}, plane.texture)});
}

inline EventOptions in_nanoseconds() {
  EventOptions options;
  options.timestamp_unit = TimestampUnit::kNanoseconds;
  return options;
}

/// The triangle that a ray intersects first.
inline TriangleId look(const Scene& scene, const Ray& ray) {
  TriangleId triangle = 0;
  scene.visible({&ray, 1}, {&triangle, 1});
  return triangle;
}

inline Shade see(const Scene& scene, const Ray& ray) { return scene.shade(ray, look(scene, ray)); }

}  // namespace saccade::testing
