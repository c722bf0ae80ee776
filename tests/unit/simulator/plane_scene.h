#pragma once

#include <utility>

#include "simulator/scene/scene_builder.h"
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

}  // namespace saccade::testing
