#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace saccade {

namespace config {
class Fields;
}

/// What a generated world is built of.
enum class WorldGeometry {
  kRoom,
  kCorridor,
  kLayers,
  kClutter,
  kFurniture,
  kRelief,
  kThin,
  kMoving,
};

/// What its surfaces show.
enum class WorldTexture {
  kPhotographs,
  kDrawings,
  kRectangles,
  kPrint,
  kFaint,
  kContrast,
  kLeaves,
};

/// A whole scene drawn from a seed (section `scene.world`): the same options give the same scene.
/// It leaves a ball around the origin free for the camera, which looks along +y with +z upwards,
/// and fills the view from everywhere in it.
struct WorldOptions {
  WorldGeometry geometry = WorldGeometry::kClutter;
  WorldTexture texture = WorldTexture::kLeaves;
  std::uint64_t seed = 1;                     ///< of the geometry
  std::optional<std::uint64_t> texture_seed;  ///< nullopt: the same
};

/// No surface of a world is nearer to the origin.
constexpr double kWorldFreeRadius_m = 0.8;

void describe(config::Fields& fields, WorldOptions& options);

/// "clutter of photographs, seed 17", for people.
[[nodiscard]] std::string world_title(const WorldOptions& options);

}  // namespace saccade
