#pragma once

#include <filesystem>

namespace saccade {

/// Keeps two programs from filling one folder at the same time; the system releases it when the
/// program ends, however that happens.
class FolderLock {
 public:
  /// `folder` exists. InputError when another program holds it.
  explicit FolderLock(const std::filesystem::path& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int descriptor_;
};

}  // namespace saccade
