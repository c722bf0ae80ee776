#pragma once

#include <filesystem>

namespace saccade {

/// A file or folder that shall not outlive this program, even where a signal ends it: what lies there is
/// removed with the object, unless it was renamed before.
class TemporaryPath {
 public:
  explicit TemporaryPath(std::filesystem::path path);
  ~TemporaryPath();
  TemporaryPath(const TemporaryPath&) = delete;
  TemporaryPath& operator=(const TemporaryPath&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// Removes what stands at all of them, for a program that ends at once: all other threads are held for good
/// (other_threads.h), so that none writes anew what was removed. From then on only async-signal-safe functions may be
/// called.
void remove_temporary_paths();

}  // namespace saccade
