#pragma once

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <vector>

#include "core/error.h"

namespace saccade {

/// A whole file. InputError with the path when it is missing, a folder or not readable.
[[nodiscard]] inline std::vector<std::byte> read_file_bytes(const std::filesystem::path& file) {
  if (!std::filesystem::exists(file)) throw InputError(file.string(), "no such file");
  if (std::filesystem::is_directory(file))
    throw InputError(file.string(), "is a folder, not a file");
  std::ifstream stream(file, std::ios::binary | std::ios::ate);
  if (!stream) throw InputError(file.string(), "cannot be opened");
  std::vector<std::byte> bytes(static_cast<std::size_t>(stream.tellg()));
  stream.seekg(0);
  stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!stream) throw InputError(file.string(), "cannot be read to its end");
  return bytes;
}

}  // namespace saccade
