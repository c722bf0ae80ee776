#include "core/io/events/packed_columns.h"

#include <algorithm>
#include <atomic>
#include <cstring>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "core/process/parallel.h"

namespace saccade {
namespace {

enum ColumnIndex : std::size_t { kX, kY, kP, kT };

/// One chunk of one column, on its way from the file into the memory.
struct ChunkOfColumn {
  std::size_t column = 0;
  std::uint64_t index = 0;
  H5Chunks::Packed packed;
};

/// The values of a chunk from `skip` on, of the type From in the file, as they are wanted in memory.
template <class From, class To>
bool convert(const std::byte* chunk, std::uint64_t skip, std::span<To> to) {
  for (std::size_t i = 0; i < to.size(); ++i) {
    From value;
    std::memcpy(&value, chunk + (skip + i) * sizeof(From), sizeof(From));
    to[i] = static_cast<To>(value);
  }
  // A time beyond the memory's range is for the library, which says what it makes of it.
  if constexpr (std::is_same_v<From, std::uint64_t>)
    return std::ranges::all_of(to, [](std::int64_t t) { return t >= 0; });
  return true;
}

bool convert_times(const H5Chunks& chunks, const std::byte* chunk, std::uint64_t skip,
                   std::span<std::int64_t> times) {
  if (chunks.value_bytes() == 4)
    return chunks.is_signed() ? convert<std::int32_t>(chunk, skip, times)
                              : convert<std::uint32_t>(chunk, skip, times);
  return chunks.is_signed() ? convert<std::int64_t>(chunk, skip, times)
                            : convert<std::uint64_t>(chunk, skip, times);
}

}  // namespace

std::optional<PackedColumns> PackedColumns::of(hid_t x, hid_t y, hid_t p, hid_t t) {
  const std::optional<H5Chunks> xs = H5Chunks::of(x), ys = H5Chunks::of(y), ps = H5Chunks::of(p),
                                ts = H5Chunks::of(t);
  if (!xs || !ys || !ps || !ts) return std::nullopt;
  const auto is_coordinate = [](const H5Chunks& column) {
    return column.value_bytes() == 2 && !column.is_signed();
  };
  if (!is_coordinate(*xs) || !is_coordinate(*ys) || ps->value_bytes() != 1 || ts->value_bytes() < 4)
    return std::nullopt;
  return PackedColumns({*xs, *ys, *ps, *ts});
}

std::uint64_t PackedColumns::longest_chunk() const {
  std::uint64_t longest = 0;
  for (const H5Chunks& column : chunks_) longest = std::max(longest, column.values());
  return longest;
}

bool PackedColumns::read(std::uint64_t begin, std::uint64_t end, EventColumns& columns) const {
  columns.resize(end - begin);
  if (begin == end) return true;
  std::vector<ChunkOfColumn> parts;
  {
    const H5Lock lock;
    for (std::size_t c = 0; c < chunks_.size(); ++c) {
      const std::uint64_t length = chunks_[c].values();
      for (std::uint64_t index = begin / length; index * length < end; ++index)
        if (!chunks_[c].read(index, parts.emplace_back(ChunkOfColumn{c, index, {}}).packed))
          return false;
    }
  }
  std::atomic<bool> is_sound = true;
  parallel_for(parts.size(), [&](std::size_t i) {
    const ChunkOfColumn& part = parts[i];
    const H5Chunks& chunks = chunks_[part.column];
    const std::uint64_t length = chunks.values();
    const std::size_t bytes = length * chunks.value_bytes();
    const auto memory = std::make_unique_for_overwrite<std::byte[]>(bytes);
    bool is_fine = chunks.unpack(part.packed, {memory.get(), bytes});
    const std::uint64_t first = std::max(begin, part.index * length);
    const std::uint64_t last = std::min(end, (part.index + 1) * length);
    const std::uint64_t skip = first - part.index * length;
    const auto wanted = [&](auto& values) {
      return std::span(values).subspan(first - begin, last - first);
    };
    if (is_fine && part.column == kX)
      is_fine = convert<std::uint16_t>(memory.get(), skip, wanted(columns.x));
    else if (is_fine && part.column == kY)
      is_fine = convert<std::uint16_t>(memory.get(), skip, wanted(columns.y));
    else if (is_fine && part.column == kP)
      is_fine = chunks.is_signed() ? convert<std::int8_t>(memory.get(), skip, wanted(columns.p))
                                   : convert<std::uint8_t>(memory.get(), skip, wanted(columns.p));
    else if (is_fine)
      is_fine = convert_times(chunks, memory.get(), skip, wanted(columns.t));
    if (!is_fine) is_sound = false;
  });
  return is_sound;
}

}  // namespace saccade
