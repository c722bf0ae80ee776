#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace saccade {

static_assert(std::endian::native == std::endian::little, "files are read as they lie in memory");

/// A number as it stands at `bytes`, in the byte order of this machine (little-endian).
template <class T>
[[nodiscard]] T load(const std::byte* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return value;
}

/// The bytes of a file from front to back, in memory that does not grow with the file. InputError
/// with the path when it is missing, a folder or not readable.
class ByteReader {
 public:
  explicit ByteReader(const std::filesystem::path& file);

  /// At least `least` bytes from offset() on, fewer only where the file ends; usually many more.
  /// Valid until the next call. What is claimed by the file itself is to be compared with left()
  /// before, because so much memory is needed.
  [[nodiscard]] std::span<const std::byte> peek(std::size_t least);
  /// Moves over bytes that peek() gave.
  void skip(std::size_t count) { begin_ += count; }
  /// Exactly `count` bytes, over which it moves; fails with "ends within WHAT" where there are
  /// fewer.
  [[nodiscard]] std::span<const std::byte> take(std::uint64_t count, std::string_view what);
  /// Moves to a place anywhere in the file.
  void seek(std::uint64_t offset);

  /// Of the next byte, from the beginning of the file.
  [[nodiscard]] std::uint64_t offset() const { return block_offset_ + begin_; }
  [[nodiscard]] std::uint64_t size() const { return size_; }
  [[nodiscard]] std::uint64_t left() const { return size_ - offset(); }
  [[nodiscard]] const std::string& name() const { return name_; }

  /// InputError at "FILE:byte OFFSET".
  [[noreturn]] void fail(std::uint64_t offset, const std::string& problem) const;

 private:
  std::string name_;
  std::ifstream stream_;
  std::uint64_t size_ = 0;
  std::uint64_t block_offset_ = 0;  ///< of the first byte of block_
  std::vector<std::byte> block_;
  std::size_t begin_ = 0;
  std::size_t end_ = 0;
};

}  // namespace saccade
