#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "simulator/scene/colour_channel.h"
#include "simulator/scene/scene_remarks.h"
#include "simulator/scene/texture/texture.h"
#include "simulator/scene/world/world_dice.h"
#include "simulator/scene/world/world_options.h"

namespace saccade {

/// One of the few textures that the surfaces of a world are cut out of.
struct WorldSheet {
  ImageF albedo;       ///< linear light
  double width_m = 0;  ///< of the surface that it covers; its texels are squares

  [[nodiscard]] Eigen::Vector2d size_m() const {
    return {width_m, width_m * albedo.height() / albedo.width()};
  }
};

/// What textures are made from.
struct WorldTextureRequest {
  WorldDice dice;
  ColourChannel channel;  ///< of pictures
  SceneRemarks& remarks;
};

struct WorldTextureKind {
  WorldTexture texture;
  const char* name;
  const char* help;  ///< part of a sentence
  std::vector<WorldSheet> (*make)(WorldTextureRequest&);
  bool varies_tone;  ///< whether surfaces show it lighter or darker
};

/// All of them: a new one is a function and a row.
[[nodiscard]] std::span<const WorldTextureKind> world_textures();
[[nodiscard]] const WorldTextureKind& find_world_texture(WorldTexture texture);

// Sheets from the pictures of Debian packages. InputError naming the package where one is missing.
[[nodiscard]] std::vector<WorldSheet> make_photographs(WorldTextureRequest& request);
[[nodiscard]] std::vector<WorldSheet> make_drawings(WorldTextureRequest& request);
// Sheets that are drawn by rules.
[[nodiscard]] std::vector<WorldSheet> make_rectangles(WorldTextureRequest& request);
[[nodiscard]] std::vector<WorldSheet> make_print(WorldTextureRequest& request);
[[nodiscard]] std::vector<WorldSheet> make_faint(WorldTextureRequest& request);
[[nodiscard]] std::vector<WorldSheet> make_contrast(WorldTextureRequest& request);
[[nodiscard]] std::vector<WorldSheet> make_leaves(WorldTextureRequest& request);

}  // namespace saccade
