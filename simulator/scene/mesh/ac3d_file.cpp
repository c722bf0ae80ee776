#include "simulator/scene/mesh/ac3d_file.h"

#include <algorithm>
#include <cctype>
#include <optional>
#include <string>
#include <string_view>

namespace saccade {
namespace {

constexpr std::string_view kAc3dMagic = "AC3D";
constexpr std::string_view kAc3dTexture = "texture ";
/// What TORCS writes for a layer without a picture.
constexpr std::string_view kAc3dNoPicture = "empty_texture_no_mapping";

bool is_ac3d_ending(const std::filesystem::path& file) {
  std::string ending = file.extension().string();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return ending == ".ac" || ending == ".acc" || ending == ".ac3d";
}

}  // namespace

ReplacedFiles ac3d_for_assimp(const FileSource& source, const std::filesystem::path& file) {
  if (!is_ac3d_ending(file)) return {};
  const std::optional<Bytes> bytes = source.read(file);
  if (!bytes) return {};
  const std::string_view text(reinterpret_cast<const char*>(bytes->data()), bytes->size());
  if (!text.starts_with(kAc3dMagic)) return {};
  Bytes kept;
  kept.reserve(bytes->size());
  bool has_texture = false;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size() - 1) + 1;
    const std::string_view line = text.substr(begin, end - begin);
    begin = end;
    if (line.starts_with("OBJECT ")) has_texture = false;
    if (line.starts_with(kAc3dTexture)) {
      const bool is_picture = !line.substr(kAc3dTexture.size()).starts_with(kAc3dNoPicture);
      if (!is_picture || has_texture) continue;
      has_texture = true;
    }
    kept.insert(kept.end(), line.begin(), line.end());
  }
  if (kept.size() == bytes->size()) return {};
  return {{file.generic_string(), std::move(kept)}};
}

}  // namespace saccade
