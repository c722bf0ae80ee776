#include "simulator/scene/world/world_texture.h"

#include <algorithm>
#include <array>

#include "core/check.h"

namespace saccade {
namespace {

constexpr std::array kTextures{
    WorldTextureKind{WorldTexture::kPhotographs, "photographs",
                     "photographs of the Debian packages mate-backgrounds and "
                     "lomiri-wallpapers-16.04",
                     make_photographs, true},
    WorldTextureKind{WorldTexture::kDrawings, "drawings",
                     "drawings of the Debian package openclipart-png pasted on paper",
                     make_drawings, true},
    WorldTextureKind{WorldTexture::kRectangles, "rectangles",
                     "rectangles of many sizes along the axes, with hard edges", make_rectangles,
                     true},
    WorldTextureKind{WorldTexture::kPrint, "print", "fine print and lines", make_print, true},
    WorldTextureKind{WorldTexture::kFaint, "faint", "shapes whose albedo is within 15 % of 0.5",
                     make_faint, false},
    WorldTextureKind{WorldTexture::kContrast, "contrast",
                     "shapes whose albedo differs by up to 10:1 from that of their neighbours",
                     make_contrast, false},
    WorldTextureKind{WorldTexture::kLeaves, "leaves", "leaves of many sizes that cover one another",
                     make_leaves, true},
};

}  // namespace

std::span<const WorldTextureKind> world_textures() { return kTextures; }

const WorldTextureKind& find_world_texture(WorldTexture texture) {
  const auto found = std::ranges::find(kTextures, texture, &WorldTextureKind::texture);
  SACCADE_CHECK(found != kTextures.end());
  return *found;
}

}  // namespace saccade
