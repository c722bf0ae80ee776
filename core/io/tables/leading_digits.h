#pragma once

#include <bit>
#include <cstdint>
#include <cstring>

namespace saccade {

/// The decimal digits that a text begins with.
struct LeadingDigits {
  std::uint32_t count = 0;  ///< of the first eight bytes
  std::uint32_t value = 0;
};

/// Of the eight bytes at `text`, all of which can be read. Without a branch per digit, which the
/// processor cannot predict: the bytes are handled at once, the digits moved to the top and their
/// values combined pairwise.
[[nodiscard, gnu::always_inline]] inline LeadingDigits leading_digits(const char* text) {
  std::uint64_t bytes = 0;
  std::memcpy(&bytes, text, sizeof bytes);
  bytes ^= 0x3030303030303030;  // digits become 0..9, everything else more
  const std::uint64_t others = ((bytes + 0x7676767676767676) | bytes) & 0x8080808080808080;
  const auto count = static_cast<std::uint32_t>(std::countr_zero(others)) / 8;
  // In two steps, since none of eight would be moved by the whole 64 bits.
  bytes = bytes << (32 - 4 * count) << (32 - 4 * count);
  bytes = bytes * 10 + (bytes >> 8);
  bytes = ((bytes & 0x000000FF000000FF) * 0x000F424000000064 +
           ((bytes >> 16) & 0x000000FF000000FF) * 0x0000271000000001) >>
          32;
  return {count, static_cast<std::uint32_t>(bytes)};
}

}  // namespace saccade
