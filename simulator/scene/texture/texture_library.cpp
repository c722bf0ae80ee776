#include "simulator/scene/texture/texture_library.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/error.h"
#include "simulator/scene/texture/normal_texture.h"
#include "simulator/scene/texture/picture.h"
#include "simulator/scene/texture/texture_generator.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;

Bytes read_texture(const FileSource& source, const fs::path& file, const std::string& user) {
  std::optional<Bytes> bytes = source.read(file);
  if (!bytes) {
    const bool is_in_archive = !source.archive().empty();
    throw InputError(user,
                     "its texture " + (is_in_archive ? FileLocation{source.archive(), file}.text() +
                                                           " is not in this archive"
                                                     : missing_file_problem(file)));
  }
  return std::move(*bytes);
}

Picture load_colour(const FileSource& source, const fs::path& file, const std::string& user,
                    std::optional<std::uint64_t> seed, SceneRemarks& remarks,
                    ColourChannel channel) {
  const std::string place = FileLocation{source.archive(), file}.text();
  const Bytes bytes = read_texture(source, file, user);
  if (!place.ends_with(".texture.yaml"))
    return decode_picture(bytes, place, remarks, {1, 1, 1}, channel);
  if (!source.archive().empty())
    throw InputError(place, "texture parameters cannot be read from within an archive");
  TextureOptions options = read_texture_options(file);
  options.seed = seed.value_or(options.seed);
  return {generate_texture(options), {}};
}

}  // namespace

TexturePair make_textures(Picture picture, const WrapModes& wrap, float alpha_scale) {
  TexturePair pair{std::make_shared<Texture>(std::move(picture.grey), wrap.u, wrap.v), nullptr};
  for (float& alpha : picture.opacity.pixels()) alpha *= alpha_scale;
  if (!std::ranges::all_of(picture.opacity.pixels(), [](float a) { return a >= 0.5F; }))
    pair.opacity = std::make_shared<Texture>(std::move(picture.opacity), wrap.u, wrap.v);
  return pair;
}

TexturePair TextureLibrary::colour(const FileSource& source, const fs::path& file,
                                   const WrapModes& wrap, const std::string& user,
                                   std::optional<std::uint64_t> seed) {
  const SeededKey key{{FileLocation{source.archive(), file}.text(), wrap}, seed};
  const auto known = colours_.find(key);
  if (known != colours_.end()) return known->second;
  return colours_[key] = load_or_grey(missing_, remarks_, [&] {
           return make_textures(load_colour(source, file, user, seed, remarks_, channel_), wrap);
         });
}

std::shared_ptr<const Texture> TextureLibrary::opacity(const FileSource& source,
                                                       const fs::path& file, const WrapModes& wrap,
                                                       const std::string& user) {
  const std::string place = FileLocation{source.archive(), file}.text();
  const auto known = opacities_.find({place, wrap});
  if (known != opacities_.end()) return known->second;
  return opacities_[{place, wrap}] =
             load_or_grey(missing_, remarks_, [&]() -> std::shared_ptr<const Texture> {
               ImageF image = decode_opacity(read_texture(source, file, user), place, remarks_);
               return std::make_shared<Texture>(std::move(image), wrap.u, wrap.v);
             });
}

std::shared_ptr<const NormalTexture> TextureLibrary::normal_map(const FileSource& source,
                                                                const fs::path& file,
                                                                const WrapModes& wrap,
                                                                const std::string& user) {
  const std::string place = FileLocation{source.archive(), file}.text();
  const auto known = normal_maps_.find({place, wrap});
  if (known != normal_maps_.end()) return known->second;
  return normal_maps_[{place, wrap}] = load_or_flat(missing_, remarks_, [&] {
           return std::make_shared<const NormalTexture>(
               decode_normal_map(read_texture(source, file, user), place, wrap));
         });
}

}  // namespace saccade
