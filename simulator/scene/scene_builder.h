#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include <Eigen/Geometry>

#include "simulator/scene/background.h"
#include "simulator/scene/mesh.h"
#include "simulator/scene/scene.h"
#include "simulator/scene/scene_options.h"

namespace saccade {

/// Reads all files of `options` and assembles them. Throws InputError naming the file that is
/// missing or wrong.
[[nodiscard]] Scene build_scene(const SceneOptions& options);

struct PreparedTriangles;

/// Assembles a scene from meshes in memory.
class SceneBuilder {
 public:
  SceneBuilder();
  ~SceneBuilder();

  /// Takes in a mesh as the next object; `world_from_mesh` is invertible. Triangles without area
  /// are left out. Returns how many are kept.
  std::size_t add(const Mesh& mesh, const Eigen::Affine3d& world_from_mesh);

  /// Lambertian surfaces under ambient light and lamps; without it the albedo is the radiance.
  void light(double ambient, std::vector<LightOptions> lights);

  /// At least one triangle was added.
  [[nodiscard]] Scene build(const Background& background) &&;

 private:
  std::unique_ptr<PreparedTriangles> opaque_;
  std::unique_ptr<PreparedTriangles> cut_out_;
  std::vector<std::shared_ptr<const Texture>> textures_;
  std::uint32_t objects_ = 0;
  bool is_lit_ = false;
  double ambient_ = 0;
  std::vector<LightOptions> lights_;
};

}  // namespace saccade
