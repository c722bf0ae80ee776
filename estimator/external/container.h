#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace saccade {

/// The words that run a command inside an image of Apptainer (or Singularity, its former name):
/// the folder `writable` is seen there under its own path, and the
/// command starts in its folder output; the folders `readable` are seen, too. Throws
/// InputError where neither program is on the search path.
[[nodiscard]] std::vector<std::string> words_in_container(
    const std::vector<std::string>& words, const std::filesystem::path& image,
    const std::filesystem::path& writable, std::span<const std::filesystem::path> readable);

}  // namespace saccade
