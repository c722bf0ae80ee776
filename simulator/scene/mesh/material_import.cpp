#include "simulator/scene/mesh/material_import.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/srgb.h"
#include "simulator/scene/texture/picture.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;

/// Texture names are relative to the mesh file and may come from Windows, with blanks behind them.
/// What is not there is looked for beside the mesh: many programs state where it was on the disk of
/// who made it.
fs::path texture_file(const ModelTexture& reference, const MaterialContext& context) {
  std::string name = reference.name;
  std::ranges::replace(name, '\\', '/');
  name.erase(name.find_last_not_of(" \t\r") + 1);
  const fs::path folder = context.mesh_file.parent_path();
  const fs::path stated = (folder / name).lexically_normal();
  if (const auto found = context.source.find(stated)) return *found;
  return context.source.find(folder / fs::path(name).filename()).value_or(stated);
}

Picture decode_embedded(const ModelPicture& texture, const std::string& source_name,
                        SceneRemarks& remarks, ColourChannel channel) {
  if (texture.height == 0)
    return decode_picture(texture.bytes, source_name, remarks, {1, 1, 1}, channel);
  Picture picture{ImageF(static_cast<int>(texture.width), static_cast<int>(texture.height)), {}};
  const std::uint8_t* bgra = texture.bytes.data();
  for (float& grey : picture.grey.pixels()) {
    grey = in_channel(channel, linear_from_srgb8(bgra[2]), linear_from_srgb8(bgra[1]),
                      linear_from_srgb8(bgra[0]));
    bgra += 4;
  }
  return picture;
}

TexturePair load_texture(const Model& model, const ModelTexture& reference,
                         const MaterialContext& context) {
  if (reference.embedded < 0)
    return context.textures.colour(context.source, texture_file(reference, context), reference.wrap,
                                   context.source_name);
  const ModelPicture& embedded = model.pictures.at(static_cast<std::size_t>(reference.embedded));
  const std::string name =
      fmt::format("{}:{}.{}", context.source_name, reference.name, embedded.hint);
  return load_or_grey(context.options.missing_texture, context.remarks, [&] {
    return make_textures(decode_embedded(embedded, name, context.remarks, context.options.channel),
                         reference.wrap);
  });
}

std::shared_ptr<const NormalTexture> load_normal_map(const Model& model,
                                                     const ModelTexture& reference,
                                                     const MaterialContext& context) {
  if (reference.embedded < 0)
    return context.textures.normal_map(context.source, texture_file(reference, context),
                                       reference.wrap, context.source_name);
  const ModelPicture& embedded = model.pictures.at(static_cast<std::size_t>(reference.embedded));
  if (embedded.height != 0) {
    context.remarks.ignore("normal maps inside the file that are not encoded", context.source_name);
    return nullptr;
  }
  const std::string name =
      fmt::format("{}:{}.{}", context.source_name, reference.name, embedded.hint);
  return load_or_flat(context.options.missing_texture, context.remarks, [&] {
    return std::make_shared<const NormalTexture>(
        decode_normal_map(embedded.bytes, name, reference.wrap));
  });
}

std::array<float, 3> linear_colour(const ModelMaterial& material) {
  if (material.is_linear) return material.colour;
  std::array<float, 3> linear{};
  std::ranges::transform(material.colour, linear.begin(), [](float c) {
    return static_cast<float>(linear_from_srgb(std::clamp(c, 0.0F, 1.0F)));
  });
  return linear;
}

}  // namespace

double grey_of(const std::array<float, 3>& colour, ColourChannel channel) {
  return in_channel(channel, colour[0], colour[1], colour[2]);
}

bool leaves_out_normal_map(const MaterialContext& context) {
  if (!context.options.is_lit)
    context.remarks.ignore("normal maps (they count under lights)", context.source_name);
  else if (!context.options.takes_normal_maps)
    context.remarks.ignore("normal maps (scene.normal_maps: true takes them)", context.source_name);
  else if (context.is_animated)
    context.remarks.ignore("normal maps of animated meshes", context.source_name);
  else
    return false;
  return true;
}

ImportedMaterial import_material(const Model& model, const ModelMaterial& material,
                                 const MaterialContext& context) {
  ImportedMaterial result;
  for (const std::string& feature : material.ignored)
    context.remarks.ignore(feature, context.source_name);
  result.material.albedo = grey_of(linear_colour(material), context.options.channel);
  if (!material.ignores_alpha) result.invisible = material.opacity < 0.5F;
  if (const auto& reference = material.colour_texture) {
    TexturePair pair = load_texture(model, *reference, context);
    if (pair.grey == nullptr) result.material.albedo = 0.5;
    result.material.texture = std::move(pair.grey);
    if (!material.ignores_alpha) result.material.opacity = std::move(pair.opacity);
    result.material.factor = material.is_linear ? result.material.albedo : 1.0;
    result.uv_channel = reference->uv_channel;
  }
  if (const auto& reference = material.normal_texture;
      reference && !leaves_out_normal_map(context)) {
    result.material.normal_map = load_normal_map(model, *reference, context);
    result.normal_uv_channel = reference->uv_channel;
  }
  if (const auto& alpha = material.opacity_texture)
    result.material.opacity = context.textures.opacity(
        context.source, texture_file(*alpha, context), alpha->wrap, context.source_name);
  return result;
}

}  // namespace saccade
