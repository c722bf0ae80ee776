#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "core/error.h"
#include "simulator/scene/colour_channel.h"
#include "simulator/scene/mesh/file_source.h"
#include "simulator/scene/scene_remarks.h"
#include "simulator/scene/texture/texture.h"

namespace saccade {

class NormalTexture;

/// What becomes of a texture that is missing or cannot be decoded: an error, or grey 0.5 and a
/// remark.
enum class MissingTexture { kError, kGrey };

/// load(), or where it throws InputError and textures may be missing, an empty result and a remark
/// that ends with what is done `instead`.
template <class Load>
auto load_or(MissingTexture missing, SceneRemarks& remarks, const char* instead, const Load& load)
    -> decltype(load()) {
  if (missing == MissingTexture::kError) return load();
  try {
    return load();
  } catch (const InputError& error) {
    remarks.say(std::string(error.what()) + "; " + instead);
    return {};
  }
}

/// The same for colours.
template <class Load>
auto load_or_grey(MissingTexture missing, SceneRemarks& remarks, const Load& load) {
  return load_or(missing, remarks, "grey 0.5 is shown instead", load);
}

/// The same for normal maps.
template <class Load>
auto load_or_flat(MissingTexture missing, SceneRemarks& remarks, const Load& load) {
  return load_or(missing, remarks, "the surface is shown without its normal map", load);
}

/// The two textures of a picture; `opacity` is null where everything is opaque, `grey` where the
/// picture is missing and shall be grey.
struct TexturePair {
  std::shared_ptr<const Texture> grey;
  std::shared_ptr<const Texture> opacity;
};

/// How a texture continues outside [0, 1].
struct WrapModes {
  Wrap u = Wrap::kRepeat;
  Wrap v = Wrap::kRepeat;
  [[nodiscard]] auto operator<=>(const WrapModes&) const = default;
};

/// The textures of a scene, each loaded or generated once. Not thread-safe.
class TextureLibrary {
 public:
  /// `remarks` outlives it. `channel`: what the textures show of pictures.
  TextureLibrary(MissingTexture missing, SceneRemarks& remarks,
                 ColourChannel channel = ColourChannel::kLuminance)
      : missing_(missing), remarks_(remarks), channel_(channel) {}

  /// `file` of `source`: a picture, or parameters for generate_texture() (*.texture.yaml, on disk).
  /// `seed`: of generated ones, in place of the file's. Throws InputError naming the picture and
  /// `user`, which asks for it.
  [[nodiscard]] TexturePair colour(const FileSource& source, const std::filesystem::path& file,
                                   const WrapModes& wrap, const std::string& user,
                                   std::optional<std::uint64_t> seed = std::nullopt);

  /// The same picture read as an alpha map.
  [[nodiscard]] std::shared_ptr<const Texture> opacity(const FileSource& source,
                                                       const std::filesystem::path& file,
                                                       const WrapModes& wrap,
                                                       const std::string& user);

  /// The same picture read as a normal map; null where it is missing and may be.
  [[nodiscard]] std::shared_ptr<const NormalTexture> normal_map(const FileSource& source,
                                                                const std::filesystem::path& file,
                                                                const WrapModes& wrap,
                                                                const std::string& user);

 private:
  using Key = std::pair<std::string, WrapModes>;
  using SeededKey = std::pair<Key, std::optional<std::uint64_t>>;
  MissingTexture missing_;
  SceneRemarks& remarks_;
  ColourChannel channel_;
  std::map<SeededKey, TexturePair> colours_;
  std::map<Key, std::shared_ptr<const Texture>> opacities_;
  std::map<Key, std::shared_ptr<const NormalTexture>> normal_maps_;
};

/// A picture as a pair of textures. `alpha_scale` multiplies the opacity.
struct Picture;
[[nodiscard]] TexturePair make_textures(Picture picture, const WrapModes& wrap,
                                        float alpha_scale = 1);

}  // namespace saccade
