#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace saccade {

/// The files of `folder` whose names begin and end so, in order of their names; none where there is
/// no such folder.
[[nodiscard]] std::vector<std::filesystem::path> files_in(const std::filesystem::path& folder,
                                                          const std::string& begin,
                                                          const std::string& end);

/// The first file whose name begins and ends so: in `folder`, in folders below it, beside it, or in
/// folders beside it. Empty: there is none. InputError where the nearest of these places holds
/// several.
[[nodiscard]] std::filesystem::path find_near(const std::filesystem::path& folder,
                                              const std::string& begin, const std::string& end);

/// `path` where it is a file whose name ends so, else the one such file in that folder; empty: there
/// is none. InputError where the folder holds several.
[[nodiscard]] std::filesystem::path file_or_in_folder(const std::filesystem::path& path,
                                                      const std::string& end);

}  // namespace saccade
