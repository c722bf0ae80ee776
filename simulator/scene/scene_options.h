#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "simulator/motion/motion_options.h"
#include "simulator/scene/light/flicker.h"
#include "simulator/scene/texture/texture_library.h"

namespace saccade {

/// The point of a mesh that its translation puts in place: the origin of its file, or, of the
/// bounding box as it stands turned in the world, the centre or the centre of the lowest face.
enum class Anchor { kOrigin, kCenter, kBottom };

/// The axis of a file that points upwards in the world.
enum class UpAxis { kY, kZ };

struct MeshOptions {
  std::filesystem::path file;
  UpAxis up = UpAxis::kZ;
  bool is_up_stated = false;
  TransformOptions transform;
  std::optional<Eigen::Vector3d> size_m;  ///< bounding box in the file's own axes, instead of scale
  Anchor anchor = Anchor::kOrigin;
  /// Moves the mesh: its poses come after everything above. Its time 0 is the recording's.
  std::optional<MotionOptions> trajectory;
};

enum class LightType { kPoint, kDirectional };

struct LightOptions {
  LightType type = LightType::kPoint;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< [m]
  Eigen::Vector3d direction = -Eigen::Vector3d::UnitZ();
  double intensity = 1;
  bool shadows = true;
  std::optional<FlickerOptions> flicker = std::nullopt;  ///< of its intensity
};

enum class Lighting { kNone, kLambertian };

/// The `scene` section of a simulation.
struct SceneOptions {
  std::vector<MeshOptions> meshes;
  double background = 0.5;
  std::filesystem::path background_picture;
  MissingTexture missing_texture = MissingTexture::kError;
  Lighting lighting = Lighting::kNone;
  double ambient = 0;
  std::optional<FlickerOptions> ambient_flicker;
  std::vector<LightOptions> lights;
};

void describe(config::Fields& fields, MeshOptions& options);
void describe(config::Fields& fields, LightOptions& options);
void describe(config::Fields& fields, SceneOptions& options);

}  // namespace saccade
