#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/io/files/byte_reader.h"

namespace saccade {

/// What a FlatBuffer is refused for; who reads the file adds where it stands.
struct FlatBufferError {
  std::string problem;
};

/// A table of a FlatBuffer (flatbuffers.dev, "FlatBuffers internals"), every access within the
/// bytes of the buffer: an offset that leads out of them is a FlatBufferError.
class FlatTable {
 public:
  /// The root of a buffer with its size in front and the identifier of its type behind the root's
  /// offset.
  [[nodiscard]] static FlatTable root(std::span<const std::byte> sized,
                                      std::string_view identifier);

  /// A number; `absent` where the table leaves the field out. Fields count from 0.
  template <class T>
  [[nodiscard]] T number(unsigned field, T absent) const {
    const std::size_t at = place(field);
    return at == 0 ? absent : value<T>(at);
  }
  /// Empty where it is left out.
  [[nodiscard]] std::string_view text(unsigned field) const;
  /// The items of a vector of structs of `item_bytes`; empty where it is left out.
  [[nodiscard]] std::span<const std::byte> structs(unsigned field, std::size_t item_bytes) const;
  /// The tables of a vector of tables; likewise.
  [[nodiscard]] std::vector<FlatTable> tables(unsigned field) const;

 private:
  FlatTable(std::span<const std::byte> buffer, std::size_t at);

  template <class T>
  [[nodiscard]] T value(std::size_t at) const {
    return load<T>(part(at, sizeof(T)).data());
  }
  [[nodiscard]] std::span<const std::byte> part(std::size_t at, std::size_t size) const;
  /// Where a field lies; 0 where the table leaves it out.
  [[nodiscard]] std::size_t place(unsigned field) const;

  std::span<const std::byte> buffer_;
  std::size_t at_ = 0;
  std::size_t fields_ = 0;  ///< where the places of the fields stand
  std::size_t fields_end_ = 0;
};

}  // namespace saccade
