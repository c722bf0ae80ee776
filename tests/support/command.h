#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/io/files/scratch_folder.h"

namespace saccade::testing {

struct CommandResult {
  int exit_code = -1;  ///< -1: ended by a signal
  std::string output;  ///< stdout and stderr as they came
};

/// Runs a program as a user would, without a shell in between.
[[nodiscard]] CommandResult run_command(const std::string& program,
                                        const std::vector<std::string>& arguments);

/// A folder of its own below the system's temporary folder, removed at the end.
class TemporaryFolder {
 public:
  [[nodiscard]] const std::filesystem::path& path() const { return folder_.path(); }
  /// Writes a text file, with the folders above it, and returns its path.
  std::filesystem::path write(const std::string& name, const std::string& text) const;

 private:
  ScratchFolder folder_;
};

/// The whole file as text; fails the running test when it cannot be read.
[[nodiscard]] std::string read_file(const std::filesystem::path& path);

}  // namespace saccade::testing
