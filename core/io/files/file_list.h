#pragma once

#include <filesystem>
#include <span>
#include <vector>

namespace saccade {

struct StampedFile {
  double t_s = 0;
  std::filesystem::path file;  ///< absolute or relative to the working folder
};

/// Lines `t file` (images.txt, depth.txt, flow.txt); files are relative to the folder of the list
/// and need not exist. Times must increase; InputError with `file:line`.
[[nodiscard]] std::vector<StampedFile> read_file_list(const std::filesystem::path& list);

/// Writes the list; files below its folder relative to it.
void write_file_list(const std::filesystem::path& list, std::span<const StampedFile> files);

}  // namespace saccade
