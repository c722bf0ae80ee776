#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>

#include "core/io/events/event_columns.h"
#include "core/io/tables/h5_chunks.h"

namespace saccade {

/// The columns x, y, p and t of events in an HDF5 file whose chunks are unpacked beside one another,
/// without the library.
class PackedColumns {
 public:
  /// Whole numbers that every value of a column fits into: those that cameras and this program write
  /// (x and y of 16 bits, p of 8, t of 32 or 64). nullopt for others, or other layouts. Hold an H5Lock;
  /// the datasets outlive this.
  [[nodiscard]] static std::optional<PackedColumns> of(hid_t x, hid_t y, hid_t p, hid_t t);

  /// Values in the longest chunk of a column.
  [[nodiscard]] std::uint64_t longest_chunk() const;
  /// The events with indices [begin, end); false where a chunk is missing or damaged, and then the library
  /// can tell what is wrong with it. Takes the H5Lock itself, but not while it unpacks.
  [[nodiscard]] bool read(std::uint64_t begin, std::uint64_t end, EventColumns& columns) const;

 private:
  explicit PackedColumns(std::array<H5Chunks, 4> chunks) : chunks_(std::move(chunks)) {}

  std::array<H5Chunks, 4> chunks_;  ///< x, y, p, t
};

}  // namespace saccade
