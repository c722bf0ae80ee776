#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "core/spline/spline.h"
#include "simulator/scene/background.h"
#include "simulator/scene/light/environment_light.h"
#include "simulator/scene/mesh/mesh.h"
#include "simulator/scene/scene.h"
#include "simulator/scene/scene_options.h"

namespace saccade {

struct NormalFrame;
struct PreparedTriangles;
class Visibility;

/// Assembles a scene from meshes in memory.
class SceneBuilder {
 public:
  SceneBuilder();
  ~SceneBuilder();

  /// Takes in a mesh as the next object; `world_from_mesh` is invertible. Triangles without area
  /// are left out, and opaque ones in the place of an earlier one of the mesh, as of surfaces that
  /// are modelled from both sides: which of both is seen would be chance. Returns how many are
  /// kept.
  std::size_t add(const Mesh& mesh, const Eigen::Affine3d& world_from_mesh,
                  const InstanceLabel& label = {});

  /// The same for an object that moves rigidly, `object_from_mesh` first.
  std::size_t add_moving(const Mesh& mesh, const Eigen::Affine3d& object_from_mesh,
                         Spline world_from_object, const InstanceLabel& label = {});

  /// The same for an object whose vertices move in its frame as the animation of its mesh has it,
  /// after `object_from_mesh`. `world_from_object`: none where its frame is the world.
  std::size_t add_animated(const Mesh& mesh, const Eigen::Affine3d& object_from_mesh,
                           const AnimationOptions& animation,
                           std::optional<Spline> world_from_object,
                           const InstanceLabel& label = {});

  /// Lambertian surfaces under ambient light and lights; without it the albedo is the radiance.
  void light(double ambient, const std::vector<LightOptions>& lights,
             const std::optional<FlickerOptions>& ambient_flicker = std::nullopt);
  /// Of a scene with light(), that of its surroundings as well.
  void light_from_around(const EnvironmentLight& environment) { environment_ = environment; }

  /// At least one triangle was added.
  [[nodiscard]] Scene build(const Background& background) &&;

 private:
  struct Body;

  std::size_t add_to(Body& body, const Mesh& mesh, const Eigen::Affine3d& body_from_mesh,
                     const InstanceLabel& label);
  /// Moves all triangles together and numbers them; the corners stay.
  [[nodiscard]] PreparedTriangles number_triangles();
  /// Into `state`, which has so many triangles.
  void set_normal_frames(std::vector<NormalFrame> frames, std::size_t triangles,
                         Scene::State& state) const;
  [[nodiscard]] Visibility make_visibility(const Scene::State& state) const;

  std::vector<Body> bodies_;  ///< what is static, then the moving objects
  std::vector<std::shared_ptr<const Texture>> textures_;
  std::vector<std::shared_ptr<const NormalTexture>> normal_maps_;
  std::vector<SceneInstance> instances_;
  std::uint32_t objects_ = 0;
  bool is_lit_ = false;
  double ambient_ = 0;
  std::optional<FlickerOptions> ambient_flicker_;
  std::vector<LightOptions> lights_;  ///< of area lights their emitters
  std::optional<EnvironmentLight> environment_;
};

}  // namespace saccade
