#pragma once

#include <filesystem>
#include <string>

namespace saccade {

/// What a dataset tells at best, for a terminal: the bounds of information.h, and for which methods
/// they are enough. Throws InputError for what is no dataset, or lacks poses, frames or depth.
[[nodiscard]] std::string describe_information(const std::filesystem::path& dataset);

}  // namespace saccade
