#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <span>
#include <string>

namespace saccade {

/// Remembers which input files were read while it lives, with the SHA-256 of their bytes, so that
/// unfinished work can tell whether it may go on. The readers of text tables, YAML, meshes and
/// pictures report to the one log there is; without one reporting costs nothing. Thread-safe.
class InputLog {
 public:
  InputLog();
  ~InputLog();
  InputLog(const InputLog&) = delete;
  InputLog& operator=(const InputLog&) = delete;

  /// Hashes so far by the file's name.
  [[nodiscard]] std::map<std::string, std::string> files() const;

  /// To be called by whoever reads a file; `name`: its path, inside an archive "archive!/member".
  static void note(const std::string& name, std::span<const std::byte> bytes);
  /// The same for a file that is read piece by piece.
  static void note(const std::filesystem::path& file);
};

}  // namespace saccade
