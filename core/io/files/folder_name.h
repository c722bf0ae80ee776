#pragma once

#include <filesystem>
#include <string>

namespace saccade {

/// `folder`, absolute and without a slash or "/." at its end, so that its parent_path() and
/// filename() are what a person would call so. "." is the working directory, "" stays
/// what it is.
[[nodiscard]] inline std::filesystem::path named_folder(const std::filesystem::path& folder) {
  if (folder.empty()) return {};
  const std::filesystem::path whole = std::filesystem::absolute(folder).lexically_normal();
  return whole.has_filename() ? whole : whole.parent_path();
}

/// The last part of it: "walls" of "data/walls/".
[[nodiscard]] inline std::string folder_name(const std::filesystem::path& folder) {
  return named_folder(folder).filename().string();
}

}  // namespace saccade
