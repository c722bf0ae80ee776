#pragma once

#include <filesystem>

#include "core/io/files/temporary_paths.h"

namespace saccade {

/// A new empty folder among the system's temporary files, this process's alone; it and all that
/// lies in it go with the object.
class ScratchFolder {
 public:
  /// InputError with the place where none can be made.
  ScratchFolder();
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return folder_.path(); }

 private:
  TemporaryPath folder_;
};

}  // namespace saccade
