#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace saccade {

struct PathDescription {
  std::string text;                   ///< for a terminal, several lines
  std::vector<std::string> problems;  ///< found by verifying, one line each; empty when all is well
};

/// What a dataset folder, a run folder or an event file holds: counts, duration, rates, sensor,
/// poses; of a run also its configuration and scores. `verify` compares a dataset with the hashes
/// in its dataset.yaml. Throws InputError for anything else, for malformed files, and for `verify`
/// where there are no hashes.
[[nodiscard]] PathDescription describe_path(const std::filesystem::path& path, bool verify = false);

}  // namespace saccade
