#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "simulator/motion/motion_options.h"

namespace saccade {

/// The point of a mesh that its translation puts in place: the origin of its file, or, of the
/// bounding box as it stands turned in the world, the centre or the centre of the lowest face.
enum class Anchor { kOrigin, kCenter, kBottom };

struct MeshOptions {
  std::filesystem::path file;  ///< everything that assimp reads, or archive.zip!/path/in/it.obj
  TransformOptions transform;
  std::optional<Eigen::Vector3d> size_m;  ///< bounding box in the file's own axes, instead of scale
  Anchor anchor = Anchor::kOrigin;
  /// Moves the mesh: its poses come after everything above. Its time 0 is the recording's.
  std::optional<MotionOptions> trajectory;
};

enum class LightType { kPoint, kDirectional };

struct LightOptions {
  LightType type = LightType::kPoint;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();     ///< of a point light [m]
  Eigen::Vector3d direction = -Eigen::Vector3d::UnitZ();  ///< in which directional light travels
  double intensity = 1;  ///< radiance of a white surface that faces the light (at 1 m of a point)
  bool shadows = true;
};

enum class Lighting { kNone, kLambertian };

/// The `scene` section of a simulation.
struct SceneOptions {
  std::vector<MeshOptions> meshes;
  double background = 0.5;                   ///< radiance that a ray meets which hits nothing
  std::filesystem::path background_picture;  ///< instead: an equirectangular environment map
  Lighting lighting = Lighting::kNone;       ///< none: the albedo is the radiance
  double ambient = 0;                        ///< radiance of a white surface without any light
  std::vector<LightOptions> lights;
};

void describe(config::Fields& fields, MeshOptions& options);
void describe(config::Fields& fields, LightOptions& options);
void describe(config::Fields& fields, SceneOptions& options);

}  // namespace saccade
