#include "simulator/scene/world/world.h"

#include <utility>

#include "simulator/scene/world/world_geometry.h"
#include "simulator/scene/world/world_texture.h"

namespace saccade {
namespace {

enum WorldTextureStream : std::uint64_t { kSheetStream = 1, kCutStream = 2 };

std::vector<Material> materials_of(std::vector<WorldSheet> sheets) {
  std::vector<Material> materials;
  for (WorldSheet& sheet : sheets) {
    Material material;
    material.texture =
        std::make_shared<const Texture>(std::move(sheet.albedo), Wrap::kMirror, Wrap::kMirror);
    materials.push_back(std::move(material));
  }
  return materials;
}

}  // namespace

World make_world(const WorldOptions& options, SceneRemarks& remarks, ColourChannel channel) {
  const std::uint64_t texture_seed = options.texture_seed.value_or(options.seed);
  WorldTextureRequest request{{texture_seed, kSheetStream}, channel, remarks};
  std::vector<WorldSheet> sheets = find_world_texture(options.texture).make(request);
  std::vector<Eigen::Vector2d> sizes_m;
  for (const WorldSheet& sheet : sheets) sizes_m.push_back(sheet.size_m());
  SheetCutter cutter(std::move(sizes_m), {texture_seed, kCutStream});
  WorldLayout layout(options.seed, cutter);
  find_world_geometry(options.geometry).build(layout);
  World world{std::move(layout.parts()), std::move(layout.files())};
  const std::vector<Material> materials = materials_of(std::move(sheets));
  for (WorldPart& part : world.parts) part.mesh.materials = materials;
  return world;
}

}  // namespace saccade
