#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "simulator/scene/mesh/file_source.h"
#include "simulator/scene/texture/texture.h"

namespace saccade {

/// The two textures of a picture; `opacity` is null where everything is opaque.
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
  /// `file` of `source`: a picture, or parameters for generate_texture() (*.texture.yaml, on disk).
  /// Throws InputError naming the picture and `user`, which asks for it.
  [[nodiscard]] TexturePair colour(const FileSource& source, const std::filesystem::path& file,
                                   const WrapModes& wrap, const std::string& user);

  /// The same picture read as an alpha map.
  [[nodiscard]] std::shared_ptr<const Texture> opacity(const FileSource& source,
                                                       const std::filesystem::path& file,
                                                       const WrapModes& wrap,
                                                       const std::string& user);

 private:
  using Key = std::pair<std::string, WrapModes>;
  std::map<Key, TexturePair> colours_;
  std::map<Key, std::shared_ptr<const Texture>> opacities_;
};

/// A picture as a pair of textures.
struct Picture;
[[nodiscard]] TexturePair make_textures(Picture picture, const WrapModes& wrap);

}  // namespace saccade
