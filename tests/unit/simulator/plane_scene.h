#pragma once

#include <memory>
#include <utility>

#include "simulator/scene/scene_builder.h"
#include "tests/support/closed_form_plane.h"

namespace saccade::testing {

/// A rectangle from `corner` along `right` and `down`, two triangles, its texture's first texel at
/// the corner.
inline Mesh rectangle(const Eigen::Vector3d& corner, const Eigen::Vector3d& right,
                      const Eigen::Vector3d& down, ImageF texture) {
  Mesh mesh;
  mesh.vertices = {corner, corner + right, corner + right + down, corner + down};
  mesh.uvs = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
  mesh.triangles = {{{0, 1, 2}, 0}, {{0, 2, 3}, 0}};
  Material material;
  material.texture = std::make_shared<const Texture>(std::move(texture));
  mesh.materials = {material};
  return mesh;
}

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
