#pragma once

#include <filesystem>
#include <span>
#include <string>

namespace saccade {

/// A picture that a Debian package brings; it is read where the package puts it.
struct WorldPicture {
  std::filesystem::path file;
  const char* package;
};

/// What is wrong where the file is missing, with the package that brings it; else "".
[[nodiscard]] std::string missing_picture_problem(const WorldPicture& picture);

// Both lists are part of what a seed means: a picture more, or another order, gives other worlds.
[[nodiscard]] std::span<const WorldPicture> world_photographs();
[[nodiscard]] std::span<const WorldPicture> world_drawings();

}  // namespace saccade
