#include "simulator/scene/world/world.h"

#include <array>
#include <span>
#include <utility>

#include "simulator/scene/world/world_geometry.h"
#include "simulator/scene/world/world_texture.h"

namespace saccade {
namespace {

enum WorldTextureStream : std::uint64_t { kSheetStream = 1, kCutStream = 2 };

/// Reflectances of paint: without them things are hard to tell from what is behind them.
constexpr std::array kTones{1.0, 0.6, 0.35};

/// All textures in the first tone, then all in the next one.
std::vector<Material> materials_of(std::vector<WorldSheet> sheets, std::span<const double> tones) {
  std::vector<Material> materials(sheets.size());
  for (std::size_t k = 0; k < sheets.size(); ++k)
    materials[k].texture =
        std::make_shared<const Texture>(std::move(sheets[k].albedo), Wrap::kMirror, Wrap::kMirror);
  for (std::size_t tone = 1; tone < tones.size(); ++tone)
    for (std::size_t k = 0; k < sheets.size(); ++k) {
      materials.push_back(materials[k]);
      materials.back().factor = tones[tone];
    }
  return materials;
}

}  // namespace

World make_world(const WorldOptions& options, SceneRemarks& remarks, ColourChannel channel) {
  const std::uint64_t texture_seed = options.texture_seed.value_or(options.seed);
  WorldTextureRequest request{{texture_seed, kSheetStream}, channel, remarks};
  const WorldTextureKind& kind = find_world_texture(options.texture);
  const auto tones = std::span(kTones).first(kind.varies_tone ? kTones.size() : 1);
  std::vector<WorldSheet> sheets = kind.make(request);
  std::vector<Eigen::Vector2d> sizes_m;
  for (const WorldSheet& sheet : sheets) sizes_m.push_back(sheet.size_m());
  SheetCutter cutter(std::move(sizes_m), static_cast<int>(tones.size()),
                     {texture_seed, kCutStream});
  WorldLayout layout(options.seed, cutter);
  find_world_geometry(options.geometry).build(layout);
  World world{std::move(layout.parts()), std::move(layout.files())};
  const std::vector<Material> materials = materials_of(std::move(sheets), tones);
  for (WorldPart& part : world.parts) part.mesh.materials = materials;
  return world;
}

}  // namespace saccade
