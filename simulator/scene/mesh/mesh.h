#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "simulator/scene/animation/mesh_animation.h"
#include "simulator/scene/light/gloss.h"
#include "simulator/scene/light/light_options.h"
#include "simulator/scene/texture/normal_texture.h"
#include "simulator/scene/texture/texture.h"

namespace saccade {

/// How a surface reflects: grey albedo in linear light.
struct Material {
  double albedo = 0.5;                     ///< without a texture
  std::shared_ptr<const Texture> texture;  ///< replaces the albedo; multiplied by `factor`
  double factor = 1;
  std::shared_ptr<const Texture> opacity;  ///< cut out where below 0.5
  /// Under lights the radiance is albedo x (irradiance + self_light). Infinite: it is the albedo.
  double self_light = 0;
  std::shared_ptr<const NormalTexture> normal_map = nullptr;  ///< bends the shading normal
  Gloss gloss{};                                              ///< what it mirrors of lights
};

struct Triangle {
  std::array<std::uint32_t, 3> corners;  ///< indices into the mesh's vertices
  std::uint32_t material;                ///< index into the mesh's materials
  std::uint32_t node = 0;  ///< index into the mesh's nodes, where it has names for them
};

/// What a mesh file holds beside surfaces.
struct MeshExtras {
  std::size_t lights = 0;
  std::size_t parts = 1, instances = 1;
};

/// Triangles in the coordinates of their file. The attributes have one entry per vertex, or none.
struct Mesh {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Eigen::Vector3d> normals;  ///< for shading; empty: each triangle is flat
  std::vector<Eigen::Vector2d> uvs;      ///< v upwards; needed where a material has a texture
  std::vector<double> colours;           ///< linear grey; replaces the albedo without a texture
  std::vector<Triangle> triangles;
  std::vector<Material> materials;
  std::vector<std::string> nodes{};  ///< names of the file's nodes that have triangles
  /// In the file's coordinates, with intensities in candela and, of directional ones, in lux; only
  /// where they were asked for.
  std::vector<LightOptions> lights{};
  MeshExtras extras{};
  std::vector<Eigen::Vector2d> normal_uvs{};  ///< of normal maps; needed where a material has one
  /// Unit tangents of normal maps, and the handedness of the bitangent, w (normal x tangent); zero
  /// where the file states none.
  std::vector<Eigen::Vector4d> tangents{};
  /// Its first pose is that of `vertices` and `normals`. nullptr: the mesh is still.
  std::shared_ptr<const MeshAnimation> animation{};
};

}  // namespace saccade
