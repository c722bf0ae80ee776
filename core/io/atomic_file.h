#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace saccade {

/// Writes a file so that its final name never holds half of it: `write` fills a hidden sibling
/// (`.NAME.partial-...`, created in the same folder), which is then renamed over `file`. On an
/// exception the sibling is removed. Missing parent folders are created. Throws InputError with the
/// path when it cannot be written (no permission, no space).
void write_atomically(const std::filesystem::path& file,
                      const std::function<void(const std::filesystem::path& temporary)>& write);
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
