#pragma once

#include <cstdint>
#include <filesystem>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "simulator/motion/motion_options.h"
#include "simulator/scene/animation/animation_options.h"
#include "simulator/scene/light/environment_light.h"
#include "simulator/scene/light/flicker.h"
#include "simulator/scene/light/gloss.h"
#include "simulator/scene/light/light_options.h"
#include "simulator/scene/texture/texture_library.h"
#include "simulator/scene/world/world_options.h"

namespace saccade {

/// The point of a mesh that its translation puts in place: the origin of its file, or, of the
/// bounding box as it stands turned in the world, the centre or the centre of the lowest face.
enum class Anchor { kOrigin, kCenter, kBottom };

/// The axis of a file that points upwards in the world.
enum class UpAxis { kY, kZ };

/// What of a mesh file masks and labels tell apart: nothing, or its nodes.
enum class Instances { kWhole, kNodes };

struct MeshOptions {
  std::filesystem::path file;
  UpAxis up = UpAxis::kZ;
  bool is_up_stated = false;
  TransformOptions transform;
  std::optional<Eigen::Vector3d> size_m;  ///< bounding box in the file's own axes, instead of scale
  Anchor anchor = Anchor::kOrigin;
  std::string class_name;                        ///< in labels; empty: none
  std::optional<std::filesystem::path> texture;  ///< in place of those of its materials
  std::optional<std::uint64_t> texture_seed;     ///< of a generated texture, in place of the file's
  double reflectance = 1;                        ///< multiplies every albedo
  std::optional<GlossOptions> gloss;             ///< of all its materials, in place of the file's
  Instances instances = Instances::kWhole;
  /// Moves the mesh: its poses come after everything above. Its time 0 is the recording's.
  std::optional<MotionOptions> trajectory;
  /// Moves its vertices, before everything above: one of the animations of its file.
  std::optional<AnimationOptions> animation;
};

enum class Lighting { kNone, kLambertian };

/// The `scene` section of a simulation.
struct SceneOptions {
  std::vector<MeshOptions> meshes;
  std::vector<MeshOptions> more_meshes;  ///< empty once read: then `meshes` has them, too
  std::optional<WorldOptions> world;     ///< generated, beside the meshes
  std::vector<std::string> classes;      ///< class k is item k - 1; empty: as the meshes name them
  double background = 0.5;
  std::filesystem::path background_picture;
  double background_yaw_deg = 0;  ///< of it, and of the picture of the environment light
  MissingTexture missing_texture = MissingTexture::kError;
  Lighting lighting = Lighting::kNone;
  double ambient = 0;
  std::optional<FlickerOptions> ambient_flicker;
  std::optional<EnvironmentLightOptions> environment_light;
  std::vector<LightOptions> lights;
  bool normal_maps = true;                    ///< of mesh files, under lights
  bool gloss = false;                         ///< of glTF files, by their roughness and metalness
  bool lights_from_meshes = false;            ///< adds those of glTF files
  double light_scale = 1 / std::numbers::pi;  ///< their intensity per candela or lux
};

/// Whether the lights of its mesh files light a scene.
[[nodiscard]] inline bool takes_lights(const SceneOptions& options) {
  return options.lighting == Lighting::kLambertian && options.lights_from_meshes;
}

/// The names of the classes 1, 2 ...: those that `options` lists, else those of its meshes in the
/// order in which they are named first.
[[nodiscard]] std::vector<std::string> class_names(const SceneOptions& options);

/// Of some lights, all emitters of area lights counted.
[[nodiscard]] std::size_t emitter_count(const std::vector<LightOptions>& lights);

void describe(config::Fields& fields, MeshOptions& options);
void describe(config::Fields& fields, SceneOptions& options);

}  // namespace saccade
