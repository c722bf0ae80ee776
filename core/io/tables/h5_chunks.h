#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/io/tables/h5_handle.h"

namespace saccade {

/// The chunks of a one-dimensional dataset of whole numbers as they are stored, so that they can be
/// unpacked beside one another and without the library, which unpacks one at a time. What is not stored
/// as expected, or does not unpack, is left to H5Dread(), which reads everything and tells what is wrong.
class H5Chunks {
 public:
  /// A chunk as it lies in the file.
  struct Packed {
    std::uint32_t skipped_filters = 0;  ///< a bit for each filter that was not applied to it
    std::vector<std::byte> bytes;
  };

  /// nullopt unless the dataset is chunked, of little-endian whole numbers, and filtered by nothing but
  /// shuffle and deflate, in that order. Hold an H5Lock; `dataset` outlives this.
  [[nodiscard]] static std::optional<H5Chunks> of(hid_t dataset);

  [[nodiscard]] std::uint64_t values() const { return values_; }  ///< in a chunk
  [[nodiscard]] std::size_t value_bytes() const { return value_bytes_; }
  [[nodiscard]] bool is_signed() const { return is_signed_; }

  /// False where the chunk was never written or cannot be read. Hold an H5Lock.
  [[nodiscard]] bool read(std::uint64_t index, Packed& packed) const;
  /// The values of a chunk, of which `values` holds as many bytes as a chunk does; false where it is
  /// damaged. Needs no lock.
  [[nodiscard]] bool unpack(const Packed& packed, std::span<std::byte> values) const;

 private:
  H5Chunks() = default;

  hid_t dataset_ = -1;
  std::uint64_t values_ = 0;
  std::size_t value_bytes_ = 0;
  bool is_signed_ = false;
  std::optional<unsigned> shuffle_;  ///< its place among the filters
  std::optional<unsigned> deflate_;
};

/// HDF5's shuffle filter: the first bytes of all values, then the second ones ...; `width`: bytes of a
/// value, 1, 2, 4 or 8.
void shuffle_bytes(std::span<const std::byte> values, std::size_t width,
                   std::span<std::byte> shuffled);
/// Its inverse.
void unshuffle_bytes(std::span<const std::byte> shuffled, std::size_t width,
                     std::span<std::byte> values);

}  // namespace saccade
