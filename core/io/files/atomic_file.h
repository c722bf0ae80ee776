#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/io/files/temporary_paths.h"

namespace saccade {

/// A file that appears under its final name only when it is complete: it is written as a hidden
/// sibling (`.NAME.partial-...`) and renamed. Missing parent folders are created, links followed.
/// Throws InputError with the path when that is not possible. The sibling goes with the object, or with
/// a program that a signal ends (temporary_paths.h).
class AtomicFile {
 public:
  explicit AtomicFile(const std::filesystem::path& file);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Where to write until commit().
  [[nodiscard]] const std::filesystem::path& path() const { return temporary_.path(); }
  /// The final name.
  [[nodiscard]] const std::filesystem::path& target() const { return target_; }

  void commit();

 private:
  std::filesystem::path target_;
  TemporaryPath temporary_;
  bool committed_ = false;
};

/// A whole file at once. Throws InputError with the path (no permission, no space).
void write_atomically(const std::filesystem::path& file, std::string_view contents);

/// Throws the InputError for a file that could not be written; `error`: errno, 0 when unknown.
[[noreturn]] void fail_to_write(const std::filesystem::path& file, int error);

/// The name under which an output folder appears when it is complete. An existing folder is
/// replaced only if it is empty or holds a file `marker` ("dataset.yaml", "run.yaml").
class FinalFolder {
 public:
  /// Links are followed. InputError when `folder` is no name to write to.
  FinalFolder(const std::filesystem::path& folder, std::string marker);

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] const std::string& marker() const { return marker_; }
  /// InputError when something stands there that must not be replaced.
  void check_replaceable() const;
  /// Creates the folders above it.
  void create_parent() const;
  /// Gives the folder `complete`, in the same file system, the final name in one step. What stood
  /// there is removed. InputError where `complete` holds no marker, which is written last: it was
  /// taken away meanwhile.
  void take(const std::filesystem::path& complete) const;

 private:
  std::filesystem::path path_;
  std::string marker_;
};

/// An output folder that appears under its final name only when it is complete.
class AtomicFolder {
 public:
  /// Creates the hidden sibling folder that is to be filled. An existing `folder` is replaced only
  /// if it is empty or holds a file `marker`, else InputError.
  AtomicFolder(const std::filesystem::path& folder, std::string marker);
  ~AtomicFolder();  ///< removes everything unless commit() was called
  AtomicFolder(const AtomicFolder&) = delete;
  AtomicFolder& operator=(const AtomicFolder&) = delete;

  /// Where to write until commit().
  [[nodiscard]] const std::filesystem::path& path() const { return temporary_.path(); }
  /// The final name.
  [[nodiscard]] const std::filesystem::path& target() const { return final_.path(); }

  /// Gives the folder its final name, in place of an existing one. Once; path() is gone afterwards.
  void commit();

 private:
  FinalFolder final_;
  TemporaryPath temporary_;
  bool committed_ = false;
};

}  // namespace saccade
