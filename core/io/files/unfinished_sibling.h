#pragma once

#include <filesystem>
#include <string>

namespace saccade {

/// A hidden name for what is not complete yet, in the folder of `target`, so that renaming stays
/// within one file system: ".NAME.KIND-OWNER-N", unique among all processes of all machines.
[[nodiscard]] std::filesystem::path unfinished_sibling(const std::filesystem::path& target,
                                                       const std::string& kind);

/// Removes from a folder what processes left under such names when they were killed; looks once at
/// each folder in the life of this process. Names of processes that are alive stay, and those of
/// another machine, or of this one before it was started anew, of which nobody here can tell.
void remove_abandoned_siblings(const std::filesystem::path& folder);

}  // namespace saccade
