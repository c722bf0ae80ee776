#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace saccade {

/// Pixels of the largest picture that is decoded, and of its longest side: a header of a few bytes
/// must not ask for all memory.
constexpr std::uint64_t kMostPixels = std::uint64_t{1} << 29U;
constexpr std::uint64_t kMostPictureSide = std::uint64_t{1} << 20U;

[[nodiscard]] bool begins_with(std::span<const std::byte> bytes, std::string_view begin);

/// InputError naming `location` where a picture has no pixels or more than are decoded.
void check_picture_size(std::uint64_t width, std::uint64_t height, const std::string& location);
/// The same, and where `file_bytes` are so few that nobody packs a picture like that: one colour can be packed
/// without a bound, and memory is taken for all of it.
void check_picture_size(std::uint64_t width, std::uint64_t height, std::size_t file_bytes,
                        const std::string& location);

/// A file of little-endian numbers. Whatever lies behind its end is an InputError: "LOCATION is no
/// `kind` picture that can be decoded: it ends too early".
class PictureBytes {
 public:
  PictureBytes(std::span<const std::byte> bytes, const std::string& location, std::string_view kind)
      : bytes_(bytes), location_(location), kind_(kind) {}

  [[nodiscard]] unsigned u8(std::size_t at) const {
    if (at >= bytes_.size()) fail("ends too early");
    return std::to_integer<unsigned>(bytes_[at]);
  }
  [[nodiscard]] unsigned u16(std::size_t at) const { return u8(at) | u8(at + 1) << 8U; }
  [[nodiscard]] std::uint32_t u32(std::size_t at) const { return u16(at) | u16(at + 2) << 16U; }
  [[nodiscard]] std::size_t size() const { return bytes_.size(); }
  /// How many bytes there are from `at` on.
  [[nodiscard]] std::size_t left(std::size_t at) const {
    return at < bytes_.size() ? bytes_.size() - at : 0;
  }
  [[noreturn]] void fail(const std::string& problem) const;

 private:
  std::span<const std::byte> bytes_;
  const std::string& location_;
  std::string_view kind_;
};

}  // namespace saccade
