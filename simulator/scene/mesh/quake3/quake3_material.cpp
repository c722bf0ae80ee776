#include "simulator/scene/mesh/quake3/quake3_material.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <optional>
#include <string_view>
#include <utility>

#include "core/error.h"

namespace saccade {
namespace {

/// Debian has the archives of OpenArena in several packages.
std::string packages_hint(const std::string& places) {
  constexpr std::string_view kOpenArena = "/usr/share/games/openarena/";
  return places.starts_with(kOpenArena)
             ? " (more of them: apt-get install openarena-081-textures openarena-data)"
             : "";
}

}  // namespace

Quake3Materials::Quake3Materials(const MaterialContext& context)
    : context_(context), files_(context.source, context.mesh_file) {
  for (const std::string& problem : files_.problems())
    context_.remarks.say(problem + "; its pictures are not looked at");
  for (const auto& [source, file] : files_.scripts())
    if (const std::optional<Bytes> bytes = source->read(file))
      shaders_.merge(parse_quake3_script(
          std::string_view(reinterpret_cast<const char*>(bytes->data()), bytes->size())));
}

Quake3Shader Quake3Materials::shader_of(const std::string& name) const {
  std::string key = name;
  for (char& c : key) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  const auto found = shaders_.find(key);
  Quake3Shader shader = found == shaders_.end() ? Quake3Shader{} : found->second;
  if (shader.picture.empty()) shader.picture = name;
  return shader;
}

TexturePair Quake3Materials::load(const std::string& picture, Wrap wrap) {
  if (const auto found = files_.picture(picture))
    return context_.textures.colour(*found->source, found->file, {wrap, wrap},
                                    context_.source_name);
  if (context_.options.missing_texture == MissingTexture::kError)
    throw InputError(
        context_.source_name,
        fmt::format("its texture '{}' (.tga, .jpg, .png) is not in {}, and no script there names "
                    "another{}; scene.missing_texture: grey shows the map without it",
                    picture, files_.places(), packages_hint(files_.places())));
  context_.remarks.show_grey(picture, context_.source_name);
  return {};
}

ImportedMaterial Quake3Materials::read(const ModelMaterial& material) {
  const Quake3Shader shader = shader_of(material.name);
  for (const auto* features : {&material.ignored, &shader.ignored})
    for (const std::string& feature : *features)
      context_.remarks.ignore(feature, context_.source_name);
  ImportedMaterial result;
  result.invisible = shader.coverage == Quake3Coverage::kNone;
  if (result.invisible) return result;
  TexturePair pair = load(shader.picture, shader.is_clamped ? Wrap::kClamp : Wrap::kRepeat);
  result.material.albedo = 0.5;
  result.material.texture = std::move(pair.grey);
  if (shader.coverage == Quake3Coverage::kWhereOpaque)
    result.material.opacity = std::move(pair.opacity);
  if (shader.uv_scale != Eigen::Vector2d(1, 1)) {
    // The game measures v from the picture's upper edge.
    Eigen::Affine2d scaled = Eigen::Affine2d::Identity();
    scaled.linear() = shader.uv_scale.asDiagonal();
    scaled.translation().y() = 1 - shader.uv_scale.y();
    result.uv_transform = scaled;
  }
  return result;
}

}  // namespace saccade
