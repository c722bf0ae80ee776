#include "simulator/scene/world/world_options.h"

#include <fmt/format.h>

#include "core/config/fields.h"
#include "simulator/scene/world/world_geometry.h"
#include "simulator/scene/world/world_texture.h"

namespace saccade {
namespace {

/// "room: a room with ...; corridor: ...".
template <class Kinds>
std::string list_of(const Kinds& kinds) {
  std::string text;
  for (const auto& kind : kinds)
    text += fmt::format("{}{}: {}", text.empty() ? "" : "; ", kind.name, kind.help);
  return text;
}

}  // namespace

void describe(config::Fields& fields, WorldOptions& options) {
  config::Names<WorldGeometry> geometries;
  for (const WorldGeometryKind& kind : world_geometries())
    geometries.emplace_back(kind.name, kind.geometry);
  fields.choice("geometry", options.geometry, geometries,
                fmt::format("What the world is built of. {}.", list_of(world_geometries())));
  config::Names<WorldTexture> textures;
  for (const WorldTextureKind& kind : world_textures())
    textures.emplace_back(kind.name, kind.texture);
  fields.choice("texture", options.texture, textures,
                fmt::format("What its surfaces show, but for furniture, which has its own "
                            "materials. {}.",
                            list_of(world_textures())));
  fields
      .value("seed", options.seed,
             "Seed of the geometry; another seed gives another world of the same kind.")
      .at_least(0);
  fields
      .value("texture_seed", options.texture_seed,
             "Seed of the textures and of what each surface shows of them; the default is 'seed'.")
      .at_least(0);
}

std::string world_title(const WorldOptions& options) {
  return fmt::format("{} of {}, seed {}", find_world_geometry(options.geometry).name,
                     find_world_texture(options.texture).name, options.seed);
}

}  // namespace saccade
