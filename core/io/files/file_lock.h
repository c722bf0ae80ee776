#pragma once

#include <filesystem>
#include <optional>

namespace saccade {

/// Keeps other programs from what a file stands for as long as it lives; the system releases it
/// when the program ends, however that happens. Its owner may remove the file with the lock.
class FileLock {
 public:
  /// Waits until nobody else holds it. The file and the folders above it are created. InputError
  /// with the path where that is not possible.
  [[nodiscard]] static FileLock wait_for(const std::filesystem::path& file);
  /// The same without waiting: nullopt while another program holds it.
  [[nodiscard]] static std::optional<FileLock> try_take(const std::filesystem::path& file);

  ~FileLock();
  FileLock(FileLock&& other) noexcept;
  FileLock& operator=(FileLock&&) = delete;

 private:
  explicit FileLock(int descriptor) : descriptor_(descriptor) {}
  static std::optional<FileLock> take(const std::filesystem::path& file, int operation);

  int descriptor_;  ///< -1: moved from
};

}  // namespace saccade
