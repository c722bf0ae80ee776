#pragma once

#include <filesystem>

namespace saccade {

/// Throws InputError where `folder` holds anything but a sweep: that is left alone.
void check_sweep_folder(const std::filesystem::path& folder);

/// Keeps two programs from filling one folder at the same time; the system releases it when the
/// program ends, however that happens.
class SweepFolderLock {
 public:
  /// `folder` exists. InputError when another program holds it.
  explicit SweepFolderLock(const std::filesystem::path& folder);
  ~SweepFolderLock();
  SweepFolderLock(const SweepFolderLock&) = delete;
  SweepFolderLock& operator=(const SweepFolderLock&) = delete;

 private:
  int descriptor_;
};

}  // namespace saccade
