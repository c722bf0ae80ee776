#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include <Eigen/Geometry>

#include "simulator/scene/mesh/gltf_file.h"
#include "simulator/scene/mesh/material_import.h"
#include "simulator/scene/texture/picture.h"

namespace saccade {

/// The materials of a glTF file in linear grey: base colour, opacity, emission and normal map. What else they
/// state is remarked, not shown.
///   radiance = luminance(base factor * base texture) * light
///              + luminance(emissive factor * emissive texture)
/// Without lights (light = 1) the sum becomes one texture. Under lights emission is shown where it is
/// a multiple of the base colour, or that is black.
/// alphaMode MASK cuts out where the opacity is below alphaCutoff, BLEND below 0.5.
class GltfMaterials {
 public:
  /// `file` and what `context` refers to outlive it.
  GltfMaterials(const GltfFile& file, const MaterialContext& context)
      : file_(file), context_(context) {}

  /// Item `index` of `materials`; the default material where there is none. Throws InputError
  /// naming the texture that is missing or cannot be decoded, unless it may be grey.
  [[nodiscard]] ImportedMaterial read(std::size_t index);

  /// Remarks what the file states beside its materials and is not shown. `is_moving`: its
  /// animations and skins are.
  void remark_ignored(bool is_moving) const;

 private:
  struct TextureUse;
  struct Base;

  [[nodiscard]] ImportedMaterial read(const nlohmann::json& material);
  [[nodiscard]] std::optional<TextureUse> texture_use(const nlohmann::json& info) const;
  /// Its picture with factors on R, G and B. Empty: missing, and shall be grey.
  [[nodiscard]] Picture picture(const TextureUse& use, const RgbF& factors) const;
  [[nodiscard]] std::size_t image_of(std::size_t texture) const;
  [[nodiscard]] Base base_of(const nlohmann::json& material) const;
  /// Without emission; null where the picture is missing and shall be grey.
  [[nodiscard]] TexturePair textures(const Base& base);
  void add_emission(const nlohmann::json& material, const Base& base,
                    ImportedMaterial& result) const;
  void add_normal_map(const nlohmann::json& material, ImportedMaterial& result);
  /// Under lights: emission counts as light that falls on the surface.
  void add_self_light(const Base& base, const std::optional<TextureUse>& use,
                      ImportedMaterial& result) const;
  [[nodiscard]] bool takes_gloss() const;
  /// `shown`: the material as far as it is read.
  [[nodiscard]] Gloss gloss_of(const nlohmann::json& material, const Material& shown);
  /// Of the colours of a picture, as numbers from 0 to 1.
  [[nodiscard]] const std::array<double, 3>& mean_codes(const TextureUse& use);
  static void take_coordinates(const TextureUse& use, ImportedMaterial& material);
  void remark_ignored(const nlohmann::json& material) const;
  void ignore(const std::string& feature) const;

  const GltfFile& file_;
  const MaterialContext& context_;
  /// By what they are made of: many materials share one.
  std::map<std::string, TexturePair> textures_;
  std::map<std::string, std::shared_ptr<const NormalTexture>> normal_maps_;
  std::map<std::size_t, std::array<double, 3>> mean_codes_;  ///< by texture
};

}  // namespace saccade
