#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace saccade {

/// A file that appears under its final name only when it is complete: it is written as a hidden
/// sibling
/// (`.NAME.partial-...`) and renamed. Missing parent folders are created, links followed. Throws
/// InputError with the path when that is not possible.
class AtomicFile {
 public:
  explicit AtomicFile(const std::filesystem::path& file);
  ~AtomicFile();  ///< removes the sibling unless commit() was called
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Where to write until commit().
  [[nodiscard]] const std::filesystem::path& path() const { return temporary_; }
  /// The final name.
  [[nodiscard]] const std::filesystem::path& target() const { return target_; }

  void commit();

 private:
  std::filesystem::path target_;
  std::filesystem::path temporary_;
  bool committed_ = false;
};

/// A whole file at once. Throws InputError with the path (no permission, no space).
void write_atomically(const std::filesystem::path& file, std::string_view contents);

/// An output folder that appears under its final name only when it is complete.
class AtomicFolder {
 public:
  /// Creates the hidden sibling folder that is to be filled. An existing `folder` is replaced only
  /// if it is empty or holds a file `marker` ("dataset.yaml", "run.yaml"), else InputError.
  AtomicFolder(const std::filesystem::path& folder, std::string marker);
  ~AtomicFolder();  ///< removes everything unless commit() was called
  AtomicFolder(const AtomicFolder&) = delete;
  AtomicFolder& operator=(const AtomicFolder&) = delete;

  /// Where to write until commit().
  [[nodiscard]] const std::filesystem::path& path() const { return temporary_; }
  /// The final name.
  [[nodiscard]] const std::filesystem::path& target() const { return target_; }

  /// Gives the folder its final name, in place of an existing one. Once; path() is gone afterwards.
  void commit();

 private:
  void check_replaceable() const;

  std::filesystem::path target_;
  std::filesystem::path temporary_;
  std::string marker_;
  bool committed_ = false;
};

}  // namespace saccade
