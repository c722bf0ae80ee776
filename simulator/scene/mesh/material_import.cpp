#include "simulator/scene/mesh/material_import.h"

#include <assimp/GltfMaterial.h>
#include <assimp/material.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <utility>

#include "core/error.h"
#include "core/srgb.h"
#include "simulator/scene/texture/picture.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;

struct TextureReference {
  std::string name;
  WrapModes wrap;
  unsigned uv_channel = 0;
};

Wrap wrap_of(int mode) {
  if (mode == aiTextureMapMode_Mirror) return Wrap::kMirror;
  return mode == aiTextureMapMode_Wrap ? Wrap::kRepeat : Wrap::kClamp;
}

std::optional<TextureReference> find_texture(const aiMaterial& material, aiTextureType type) {
  aiString name;
  if (material.GetTexture(type, 0, &name) != aiReturn_SUCCESS || name.length == 0)
    return std::nullopt;
  TextureReference reference{name.C_Str(), {}, 0};
  int mode = aiTextureMapMode_Wrap;
  if (material.Get(AI_MATKEY_MAPPINGMODE_U(type, 0), mode) == aiReturn_SUCCESS)
    reference.wrap.u = wrap_of(mode);
  if (material.Get(AI_MATKEY_MAPPINGMODE_V(type, 0), mode) == aiReturn_SUCCESS)
    reference.wrap.v = wrap_of(mode);
  int channel = 0;
  if (material.Get(AI_MATKEY_UVWSRC(type, 0), channel) == aiReturn_SUCCESS && channel >= 0)
    reference.uv_channel = static_cast<unsigned>(channel);
  return reference;
}

/// Texture names are relative to the mesh file and may come from Windows, with blanks behind them.
fs::path texture_file(const TextureReference& reference, const MaterialContext& context) {
  std::string name = reference.name;
  std::ranges::replace(name, '\\', '/');
  name.erase(name.find_last_not_of(" \t\r") + 1);
  return (context.mesh_file.parent_path() / name).lexically_normal();
}

Picture decode_embedded(const aiTexture& texture, const std::string& source_name) {
  if (texture.mHeight == 0) {
    const auto* bytes = reinterpret_cast<const unsigned char*>(texture.pcData);
    return decode_picture({bytes, bytes + texture.mWidth}, source_name);
  }
  Picture picture{ImageF(static_cast<int>(texture.mWidth), static_cast<int>(texture.mHeight)), {}};
  std::transform(texture.pcData, texture.pcData + picture.grey.size(), picture.grey.data(),
                 [](const aiTexel& t) {
                   return luminance(linear_from_srgb8(t.r), linear_from_srgb8(t.g),
                                    linear_from_srgb8(t.b));
                 });
  return picture;
}

TexturePair load_texture(const TextureReference& reference, const MaterialContext& context) {
  if (const aiTexture* embedded = context.scene.GetEmbeddedTexture(reference.name.c_str())) {
    const std::string hint = embedded->achFormatHint;
    return make_textures(decode_embedded(*embedded, fmt::format("{}:{}.{}", context.source_name,
                                                                reference.name, hint)),
                         reference.wrap);
  }
  return context.textures.colour(context.source, texture_file(reference, context), reference.wrap,
                                 context.source_name);
}

double grey_of(const aiColor3D& colour, bool is_linear) {
  const auto linear = [&](float c) {
    return is_linear ? c : static_cast<float>(linear_from_srgb(std::clamp(c, 0.0F, 1.0F)));
  };
  return luminance(linear(colour.r), linear(colour.g), linear(colour.b));
}

bool ignores_alpha(const aiMaterial& material) {
  aiString mode;
  return material.Get(AI_MATKEY_GLTF_ALPHAMODE, mode) == aiReturn_SUCCESS &&
         std::strcmp(mode.C_Str(), "OPAQUE") == 0;
}

}  // namespace

ImportedMaterial import_material(const aiMaterial& material, const MaterialContext& context) {
  ImportedMaterial result;
  // Only glTF states an alpha mode, and defines its colours in linear light.
  aiString mode;
  const bool is_gltf = material.Get(AI_MATKEY_GLTF_ALPHAMODE, mode) == aiReturn_SUCCESS;
  aiColor3D colour(0.5F, 0.5F, 0.5F);
  material.Get(AI_MATKEY_COLOR_DIFFUSE, colour);
  result.material.albedo = grey_of(colour, is_gltf);
  float opacity = 1;
  if (material.Get(AI_MATKEY_OPACITY, opacity) == aiReturn_SUCCESS && !ignores_alpha(material))
    result.invisible = opacity < 0.5F;

  std::optional<TextureReference> reference = find_texture(material, aiTextureType_DIFFUSE);
  if (!reference) reference = find_texture(material, aiTextureType_BASE_COLOR);
  if (reference) {
    TexturePair pair = load_texture(*reference, context);
    result.material.texture = std::move(pair.grey);
    if (!ignores_alpha(material)) result.material.opacity = std::move(pair.opacity);
    result.material.factor = is_gltf ? result.material.albedo : 1.0;
    result.uv_channel = reference->uv_channel;
  }
  if (const auto alpha = find_texture(material, aiTextureType_OPACITY))
    result.material.opacity = context.textures.opacity(
        context.source, texture_file(*alpha, context), alpha->wrap, context.source_name);
  return result;
}

}  // namespace saccade
