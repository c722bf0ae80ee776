#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

namespace saccade {

/// A whole file. InputError with the path when it is missing, a folder or not readable.
[[nodiscard]] std::vector<std::byte> read_file_bytes(const std::filesystem::path& file);

}  // namespace saccade
