#pragma once

#include <filesystem>
#include <span>

namespace saccade {

/// A picture that a Debian package brings; it is read where the package puts it.
struct WorldPicture {
  std::filesystem::path file;
  const char* package;
};

// Both lists are part of what a seed means: a picture more, or another order, gives other worlds.
[[nodiscard]] std::span<const WorldPicture> world_photographs();
[[nodiscard]] std::span<const WorldPicture> world_drawings();

}  // namespace saccade
