#include "simulator/scene/mesh/gltf_material.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <utility>

#include "core/error.h"
#include "simulator/scene/texture/picture.h"

namespace saccade {
namespace {

using nlohmann::json;

const json& member(const json& object, const char* key) {
  static const json kNone;
  return object.is_object() && object.contains(key) ? object[key] : kNone;
}

const json& extension(const json& object, const char* name) {
  return member(member(object, "extensions"), name);
}

template <std::size_t n>
std::array<float, n> numbers(const json& list, std::array<float, n> initial) {
  if (list.is_array())
    for (std::size_t i = 0; i < std::min(n, list.size()); ++i) initial[i] = list[i].get<float>();
  return initial;
}

float number(const json& value, float initial) {
  return value.is_number() ? value.get<float>() : initial;
}

Wrap gltf_wrap(const json& code) {
  constexpr int kClampToEdge = 33071, kMirroredRepeat = 33648;
  if (code == kClampToEdge) return Wrap::kClamp;
  return code == kMirroredRepeat ? Wrap::kMirror : Wrap::kRepeat;
}

/// KHR_texture_transform, for coordinates whose v goes upwards:
///   (u, v)' = translation * rotation * scale (u, v)   with v downwards
/// where rotation turns counter-clockwise as the picture is seen.
std::optional<Eigen::Affine2d> uv_transform_of(const json& info) {
  const json& stated = extension(info, "KHR_texture_transform");
  if (!stated.is_object()) return std::nullopt;
  const auto offset = numbers<2>(member(stated, "offset"), {0, 0});
  const auto scale = numbers<2>(member(stated, "scale"), {1, 1});
  const double angle = static_cast<double>(number(member(stated, "rotation"), 0));
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  Eigen::Affine2d downwards = Eigen::Affine2d::Identity();
  downwards.linear() << c, s, -s, c;
  downwards.linear() =
      downwards.linear() * Eigen::Vector2d(scale[0], scale[1]).asDiagonal().toDenseMatrix();
  downwards.translation() << static_cast<double>(offset[0]), static_cast<double>(offset[1]);
  Eigen::Affine2d flip = Eigen::Affine2d::Identity();
  flip.linear()(1, 1) = -1;
  flip.translation().y() = 1;
  return flip * downwards * flip;
}

bool is_black(const RgbF& colour) {
  return std::ranges::all_of(colour, [](float c) { return c == 0; });
}

double mean_of(const ImageF& image) {
  const std::span<const float> values = image.pixels();
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

ImageF constant_image(float value) { return {2, 2, value}; }

/// The sum of two pictures that cover the same square, in the finer one's texels.
ImageF sum_of(const ImageF& a, const ImageF& b, const WrapModes& wrap) {
  const Texture first(a, wrap.u, wrap.v);
  const Texture second(b, wrap.u, wrap.v);
  ImageF sum(std::max(a.width(), b.width()), std::max(a.height(), b.height()));
  for (int y = 0; y < sum.height(); ++y)
    for (int x = 0; x < sum.width(); ++x) {
      const double u = (x + 0.5) / sum.width();
      const double v = 1 - (y + 0.5) / sum.height();
      sum(x, y) = static_cast<float>(first.at(u, v) + second.at(u, v));
    }
  return sum;
}

}  // namespace

/// A texture as a material asks for it.
struct GltfMaterials::TextureUse {
  std::size_t texture = 0;
  WrapModes wrap;
  std::uint32_t uv_channel = 0;
  std::optional<Eigen::Affine2d> uv_transform;

  [[nodiscard]] bool lies_like(const TextureUse& other) const {
    const auto matrix = [](const TextureUse& use) {
      return use.uv_transform.value_or(Eigen::Affine2d::Identity()).matrix();
    };
    return uv_channel == other.uv_channel && wrap == other.wrap && matrix(*this) == matrix(other);
  }
};

/// A surface on the way to a texture and a factor.
struct GltfMaterials::Base {
  std::optional<TextureUse> use;  ///< none: the colour alone
  RgbF colour{1, 1, 1};
  float opacity = 1;
  float alpha_scale = 0;  ///< what is below 0.5 times this is cut out; 0: nothing is
  RgbF emission{0, 0, 0};

  /// The colour is the product of these two. A grey one is all factor, so that the materials that
  /// differ by it share a texture.
  [[nodiscard]] float factor() const { return std::max({colour[0], colour[1], colour[2]}); }
  [[nodiscard]] RgbF weights() const {
    const float scale = factor() > 0 ? 1 / factor() : 0;
    if (scale == 0) return {1, 1, 1};
    RgbF weights = colour;
    for (float& weight : weights) weight = weight == factor() ? 1 : weight * scale;
    return weights;
  }
};

void GltfMaterials::take_coordinates(const TextureUse& use, ImportedMaterial& material) {
  material.uv_channel = use.uv_channel;
  material.uv_transform = use.uv_transform;
}

std::size_t GltfMaterials::image_of(std::size_t texture) const {
  const json& stated = file_.item("textures", texture);
  const json& webp = member(extension(stated, "EXT_texture_webp"), "source");
  if (webp.is_number()) return webp.get<std::size_t>();
  const json& plain = member(stated, "source");
  if (plain.is_number()) return plain.get<std::size_t>();
  const json& dds = member(extension(stated, "MSFT_texture_dds"), "source");
  if (dds.is_number()) return dds.get<std::size_t>();
  const std::string name = fmt::format(
      "texture {} '{}'", texture,
      member(stated, "name").is_string() ? stated["name"].get<std::string>() : std::string());
  if (extension(stated, "KHR_texture_basisu").is_object())
    throw InputError(file_.source_name(),
                     name +
                         " is stored as KTX2 alone (extension KHR_texture_basisu), which cannot "
                         "be decoded: save it as PNG, JPEG or WebP");
  throw InputError(file_.source_name(), name + " does not exist or has no picture");
}

std::optional<GltfMaterials::TextureUse> GltfMaterials::texture_use(const json& info) const {
  if (!info.is_object()) return std::nullopt;
  TextureUse use;
  use.texture = info.at("index").get<std::size_t>();
  use.uv_channel = info.value("texCoord", 0U);
  const json& other_channel = member(extension(info, "KHR_texture_transform"), "texCoord");
  if (other_channel.is_number()) use.uv_channel = other_channel.get<std::uint32_t>();
  use.uv_transform = uv_transform_of(info);
  const json& sampler = member(file_.item("textures", use.texture), "sampler");
  if (sampler.is_number()) {
    const json& modes = file_.item("samplers", sampler.get<std::size_t>());
    use.wrap = {gltf_wrap(member(modes, "wrapS")), gltf_wrap(member(modes, "wrapT"))};
  }
  return use;
}

Picture GltfMaterials::picture(const TextureUse& use, const RgbF& factors) const {
  return load_or_grey(context_.options.missing_texture, context_.remarks, [&] {
    const GltfFile::NamedBytes image = file_.image(image_of(use.texture));
    return decode_picture(image.bytes, image.name, context_.remarks, factors,
                          context_.options.channel);
  });
}

void GltfMaterials::ignore(const std::string& feature) const {
  context_.remarks.ignore(feature, context_.source_name);
}

ImportedMaterial GltfMaterials::read(std::size_t index) {
  try {
    return read(file_.item("materials", index));
  } catch (const json::exception& error) {
    throw InputError(file_.source_name(),
                     fmt::format("material {} is not as glTF has it: {}", index, error.what()));
  }
}

GltfMaterials::Base GltfMaterials::base_of(const json& material) const {
  const json& older = extension(material, "KHR_materials_pbrSpecularGlossiness");
  const json& newer = member(material, "pbrMetallicRoughness");
  const bool is_older = older.is_object() && !newer.is_object();
  const json& surface = is_older ? older : newer;
  const auto rgba =
      numbers<4>(member(surface, is_older ? "diffuseFactor" : "baseColorFactor"), {1, 1, 1, 1});
  Base base;
  base.use = texture_use(member(surface, is_older ? "diffuseTexture" : "baseColorTexture"));
  base.colour = {rgba[0], rgba[1], rgba[2]};
  base.opacity = rgba[3];
  const json& mode = member(material, "alphaMode");
  const float cutoff = number(member(material, "alphaCutoff"), 0.5F);
  if (mode == "BLEND") base.alpha_scale = 1;
  // The renderer cuts out below 0.5; bilinear interpolation keeps a factor.
  if (mode == "MASK" && cutoff > 0) base.alpha_scale = 0.5F / cutoff;
  if (mode == "BLEND" && (base.opacity < 1 || base.use)) {
    const json& name = member(material, "name");
    context_.remarks.cut_out(
        name.is_string() ? fmt::format("'{}'", name.get<std::string>()) : "one without a name",
        context_.source_name);
  }
  base.emission = numbers<3>(member(material, "emissiveFactor"), {0, 0, 0});
  const float strength =
      number(member(extension(material, "KHR_materials_emissive_strength"), "emissiveStrength"), 1);
  for (float& part : base.emission) part *= strength;
  return base;
}

TexturePair GltfMaterials::textures(const Base& base) {
  const RgbF weights = base.weights();
  const float alpha = base.alpha_scale * base.opacity;
  const std::string key =
      fmt::format("{} {} {} {} {} {} {}", base.use->texture, weights[0], weights[1], weights[2],
                  static_cast<int>(base.use->wrap.u), static_cast<int>(base.use->wrap.v), alpha);
  const auto known = textures_.find(key);
  if (known != textures_.end()) return known->second;
  Picture shown = picture(*base.use, weights);
  if (shown.grey.empty()) return textures_[key] = {};
  if (base.alpha_scale == 0) shown.opacity = {};
  return textures_[key] = make_textures(std::move(shown), base.use->wrap, alpha);
}

void GltfMaterials::add_emission(const json& material, const Base& base,
                                 ImportedMaterial& result) const {
  if (is_black(base.emission)) return;
  const std::optional<TextureUse> use = texture_use(member(material, "emissiveTexture"));
  if (context_.options.is_lit) return add_self_light(base, use, result);
  Material& surface = result.material;
  if (use && base.use && surface.texture && !base.use->lies_like(*use))
    return ignore("emissive textures that lie otherwise than those of the base colour");
  ImageF light =
      constant_image(static_cast<float>(grey_of(base.emission, context_.options.channel)));
  if (use) {
    light = picture(*use, base.emission).grey;
    if (light.empty()) return;  // missing, and remarked
  }
  if (!use && surface.texture == nullptr) {
    result.emission = grey_of(base.emission, context_.options.channel);
    surface.albedo += result.emission;
    return;
  }
  const auto albedo = static_cast<float>(surface.texture ? surface.factor : surface.albedo);
  ImageF below = surface.texture ? surface.texture->image() : constant_image(1);
  for (float& value : below.pixels()) value *= albedo;
  const WrapModes wrap = use ? use->wrap : base.use->wrap;
  surface.texture = std::make_shared<Texture>(sum_of(below, light, wrap), wrap.u, wrap.v);
  surface.factor = 1;
  result.emission = grey_of(base.emission, context_.options.channel);
  if (use) take_coordinates(*use, result);
}

void GltfMaterials::add_normal_map(const json& material, ImportedMaterial& result) {
  const json& info = member(material, "normalTexture");
  const std::optional<TextureUse> use = texture_use(info);
  if (!use || leaves_out_normal_map(context_)) return;
  const float scale = number(member(info, "scale"), 1);
  const std::string key = fmt::format("{} {} {} {}", use->texture, static_cast<int>(use->wrap.u),
                                      static_cast<int>(use->wrap.v), scale);
  const auto [known, is_new] = normal_maps_.try_emplace(key);
  if (is_new)
    known->second = load_or_flat(context_.options.missing_texture, context_.remarks, [&] {
      const GltfFile::NamedBytes image = file_.image(image_of(use->texture));
      return std::make_shared<const NormalTexture>(
          decode_normal_map(image.bytes, image.name, use->wrap, scale));
    });
  result.material.normal_map = known->second;
  result.normal_uv_channel = use->uv_channel;
  result.normal_uv_transform = use->uv_transform;
}

void GltfMaterials::add_self_light(const Base& base, const std::optional<TextureUse>& use,
                                   ImportedMaterial& result) const {
  Material& surface = result.material;
  // Or so in the channel that is shown.
  if (grey_of(base.colour, context_.options.channel) == 0) {
    surface.albedo = grey_of(base.emission, context_.options.channel);
    surface.texture = nullptr;
    result.colour = base.emission;
    if (use) {
      Picture light = picture(*use, base.emission);
      if (light.grey.empty()) return;  // missing, and remarked
      surface.texture = std::make_shared<Texture>(std::move(light.grey), use->wrap.u, use->wrap.v);
      surface.factor = 1;
      take_coordinates(*use, result);
    }
    surface.self_light = std::numeric_limits<double>::infinity();
    return;
  }
  const bool is_same_picture = use && base.use
                                   ? use->texture == base.use->texture && use->lies_like(*base.use)
                                   : !use && !base.use;
  // Of both colours in one direction, or of grey through a picture alone.
  const double ratio = grey_of(base.emission, context_.options.channel) /
                       grey_of(base.colour, context_.options.channel);
  const bool is_multiple = [&] {
    for (std::size_t k = 0; k < 3; ++k)
      if (std::abs(static_cast<double>(base.emission[k]) -
                   ratio * static_cast<double>(base.colour[k])) > 1e-4 * (1 + ratio))
        return !use && !base.use;
    return true;
  }();
  if (!is_same_picture || !is_multiple)
    return ignore("emission that is no multiple of the base colour, under lights");
  surface.self_light = ratio;
}

ImportedMaterial GltfMaterials::read(const json& material) {
  remark_ignored(material);
  const Base base = base_of(material);
  ImportedMaterial result;
  result.colour = base.colour;
  result.material.albedo = grey_of(base.colour, context_.options.channel);
  result.invisible = base.alpha_scale > 0 && base.opacity * base.alpha_scale < 0.5F;
  if (base.use) {
    const TexturePair pair = textures(base);
    take_coordinates(*base.use, result);
    result.material.texture = pair.grey;
    result.material.opacity = pair.opacity;
    result.material.factor = static_cast<double>(base.factor());
    if (pair.grey == nullptr) {
      result.colour = {0.5F, 0.5F, 0.5F};
      result.material.albedo = 0.5;
    }
  }
  add_emission(material, base, result);
  add_normal_map(material, result);
  if (takes_gloss()) result.material.gloss = gloss_of(material, result.material);
  return result;
}

bool GltfMaterials::takes_gloss() const {
  return context_.options.is_lit && context_.options.takes_gloss;
}

/// A metal mirrors its base colour, anything else 4 % of all colours. Of pictures the mean counts. A
/// material that says nothing of it is matt.
Gloss GltfMaterials::gloss_of(const json& material, const Material& shown) {
  constexpr double kDielectric = 0.04;
  const json& surface = member(material, "pbrMetallicRoughness");
  if (!surface.is_object() || extension(material, "KHR_materials_unlit").is_object()) return {};
  auto roughness = static_cast<double>(number(member(surface, "roughnessFactor"), 1));
  auto metalness = static_cast<double>(number(member(surface, "metallicFactor"), 1));
  if (const auto use = texture_use(member(surface, "metallicRoughnessTexture"))) {
    const std::array<double, 3> codes = mean_codes(*use);
    roughness *= codes[1];
    metalness *= codes[2];
  }
  const double metal = std::clamp(
      shown.texture ? shown.factor * mean_of(shown.texture->image()) : shown.albedo, 0.0, 1.0);
  return make_gloss(std::lerp(kDielectric, metal, std::clamp(metalness, 0.0, 1.0)), roughness);
}

const std::array<double, 3>& GltfMaterials::mean_codes(const TextureUse& use) {
  const auto [known, is_new] = mean_codes_.try_emplace(use.texture, std::array{1.0, 1.0, 1.0});
  if (!is_new) return known->second;
  const auto decode = [&] {
    const GltfFile::NamedBytes image = file_.image(image_of(use.texture));
    return std::make_shared<const NormalTexture>(  // numbers, as of a normal map
        decode_normal_map(image.bytes, image.name, use.wrap));
  };
  const auto map = load_or(context_.options.missing_texture, context_.remarks,
                           "the factors of roughness and metalness count without it", decode);
  for (std::size_t k = 0; map && k < known->second.size(); ++k)
    known->second[k] = 0.5 * (mean_of(map->part(k).image()) + 1);
  return known->second;
}

void GltfMaterials::remark_ignored(const json& material) const {
  if (!material.is_object()) return;
  const json& surface = member(material, "pbrMetallicRoughness");
  if (member(material, "occlusionTexture").is_object()) ignore("occlusion maps");
  const bool has_picture = member(surface, "metallicRoughnessTexture").is_object();
  if (takes_gloss() && has_picture)
    ignore("pictures of roughness and metalness (their mean counts)");
  else if (!takes_gloss() && (has_picture || (surface.is_object() &&
                                              number(member(surface, "metallicFactor"), 1) > 0)))
    ignore("metallic reflection");
  for (const auto& [name, content] : member(material, "extensions").items()) {
    if (name == "KHR_materials_unlit") {
      if (context_.options.is_lit) ignore("materials without light (all are lit)");
    } else if (name == "KHR_materials_pbrSpecularGlossiness") {
      ignore("specular reflection");
    } else if (name != "KHR_materials_emissive_strength") {
      ignore(name);
    }
  }
}

void GltfMaterials::remark_ignored(bool is_moving) const {
  const json& document = file_.document();
  const auto has = [&document](const char* key) {
    return member(document, key).is_array() && !document[key].empty();
  };
  if (has("animations") && !is_moving) ignore("animations");
  if (has("skins") && !is_moving) ignore("skins (meshes stand as they are modelled)");
  for (const json& mesh : member(document, "meshes"))
    for (const json& primitive : member(mesh, "primitives"))
      if (member(primitive, "targets").is_array()) ignore("morph targets");
  for (const json& name : member(document, "extensionsUsed"))
    if (name == "KHR_lights_punctual" && !context_.options.takes_lights)
      ignore("KHR_lights_punctual (scene.lights_from_meshes: true takes those)");
}

}  // namespace saccade
