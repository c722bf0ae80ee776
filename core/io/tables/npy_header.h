#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace saccade {

/// What a header is refused for; who reads the file adds where it stands.
struct NpyError {
  std::string problem;
};

/// A kind of numbers in an array: 'i' signed, 'u' unsigned, 'f' floating, 'b' truth, 'U' text.
struct NpyType {
  char kind = 'f';
  std::size_t bytes = 8;  ///< of one; of text: 4 for each character
};

/// A field of a structured array; of a plain one there is a single field without a name.
struct NpyField {
  std::string name;
  NpyType type;
  std::size_t offset = 0;  ///< within an item
};

/// The header of an array in NumPy's format (NEP 1).
struct NpyHeader {
  std::vector<NpyField> fields;
  std::size_t item_bytes = 0;
  std::vector<std::uint64_t> shape;
  bool is_fortran = false;  ///< columns lie behind one another rather than rows
};

constexpr std::string_view kNpyMagic = "\x93NUMPY";
/// Magic, version and, at most, the length of the header.
constexpr std::size_t kNpyPrefixBytes = 12;

/// How many bytes the header has from the beginning of the file on, by the first kNpyPrefixBytes.
[[nodiscard]] std::size_t npy_header_bytes(std::string_view prefix);
/// Parses so many. NpyError for everything malformed, and for numbers in big-endian order.
[[nodiscard]] NpyHeader parse_npy_header(std::string_view header);

/// The header of a plain little-endian array, e.g. "<i8" and {100}; no size: a single number.
[[nodiscard]] std::string npy_header_text(std::string_view type,
                                          const std::vector<std::uint64_t>& shape);

}  // namespace saccade
