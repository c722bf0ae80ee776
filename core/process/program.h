#pragma once

#include <filesystem>
#include <string>

namespace saccade {

/// The file of the running program, for this process and those that it starts. It is the right one
/// even after a new build has taken its place.
[[nodiscard]] std::filesystem::path program_file();

/// Version, commit, size and time of the running program: tells builds of the same version apart.
[[nodiscard]] std::string program_identity();

}  // namespace saccade
