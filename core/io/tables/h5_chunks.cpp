#include "core/io/tables/h5_chunks.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <type_traits>

#include "core/check.h"
#include "core/io/files/zlib_stream.h"

namespace saccade {
namespace {

/// Values that are rearranged together: few enough for the nearest cache.
constexpr std::size_t kPart = 512;
constexpr std::size_t kWidest = 8;
using PartMemory = std::array<std::byte, kPart * kWidest / 2>;

/// a0 b0 a1 b1 ... of halves of T bytes each; compilers make a few unpack instructions of it.
template <class T>
void interleave(const std::byte* a, const std::byte* b, std::size_t count, std::byte* to) {
  for (std::size_t i = 0; i < count; ++i) {
    std::memcpy(to + 2 * i * sizeof(T), a + i * sizeof(T), sizeof(T));
    std::memcpy(to + (2 * i + 1) * sizeof(T), b + i * sizeof(T), sizeof(T));
  }
}

/// Its inverse.
template <class T>
void deinterleave(const std::byte* from, std::size_t count, std::byte* a, std::byte* b) {
  for (std::size_t i = 0; i < count; ++i) {
    std::memcpy(a + i * sizeof(T), from + 2 * i * sizeof(T), sizeof(T));
    std::memcpy(b + i * sizeof(T), from + (2 * i + 1) * sizeof(T), sizeof(T));
  }
}

/// At most kPart values of 1, 2, 4 or 8 bytes from planes that begin `stride` apart: their lower halves,
/// their upper halves, and these interleaved.
template <std::size_t kWidth>
void join_planes(const std::byte* planes, std::size_t stride, std::size_t count,
                 std::byte* values) {
  if constexpr (kWidth == 1) {
    std::memcpy(values, planes, count);
  } else if constexpr (kWidth == 2) {
    interleave<std::uint8_t>(planes, planes + stride, count, values);
  } else {
    using Half = std::conditional_t<kWidth == 4, std::uint16_t, std::uint32_t>;
    PartMemory lower, upper;
    join_planes<kWidth / 2>(planes, stride, count, lower.data());
    join_planes<kWidth / 2>(planes + kWidth / 2 * stride, stride, count, upper.data());
    interleave<Half>(lower.data(), upper.data(), count, values);
  }
}

/// Its inverse.
template <std::size_t kWidth>
void split_planes(const std::byte* values, std::size_t count, std::byte* planes,
                  std::size_t stride) {
  if constexpr (kWidth == 1) {
    std::memcpy(planes, values, count);
  } else if constexpr (kWidth == 2) {
    deinterleave<std::uint8_t>(values, count, planes, planes + stride);
  } else {
    using Half = std::conditional_t<kWidth == 4, std::uint16_t, std::uint32_t>;
    PartMemory lower, upper;
    deinterleave<Half>(values, count, lower.data(), upper.data());
    split_planes<kWidth / 2>(lower.data(), count, planes, stride);
    split_planes<kWidth / 2>(upper.data(), count, planes + kWidth / 2 * stride, stride);
  }
}

/// Calls body(std::integral_constant of the width) for the widths that values have here.
template <class Body>
void for_width(std::size_t width, const Body& body) {
  switch (width) {
    case 1:
      return body(std::integral_constant<std::size_t, 1>());
    case 2:
      return body(std::integral_constant<std::size_t, 2>());
    case 4:
      return body(std::integral_constant<std::size_t, 4>());
    default:
      SACCADE_CHECK(width == kWidest);
      return body(std::integral_constant<std::size_t, kWidest>());
  }
}

/// Whether the type is one of little-endian whole numbers of 1, 2, 4 or 8 bytes.
bool is_plain_integer(hid_t type, std::size_t width) {
  if (H5Tget_class(type) != H5T_INTEGER || H5Tget_precision(type) != 8 * width) return false;
  if (width != 1 && width != 2 && width != 4 && width != 8) return false;
  return width == 1 || H5Tget_order(type) == H5T_ORDER_LE;
}

}  // namespace

std::optional<H5Chunks> H5Chunks::of(hid_t dataset) {
  // Longer chunks than anybody writes would take memory for which the library asks only when they are there.
  // Of shorter ones each costs more than its values do.
  constexpr hsize_t kLeastValues = 256, kMostValues = hsize_t{1} << 22U;
  const H5Handle space = {H5Dget_space(dataset), H5Sclose};
  const H5Handle layout = {H5Dget_create_plist(dataset), H5Pclose};
  const H5Handle type = {H5Dget_type(dataset), H5Tclose};
  hsize_t length = 0;
  H5Chunks chunks;
  chunks.dataset_ = dataset;
  chunks.value_bytes_ = H5Tget_size(type);
  if (!is_plain_integer(type, chunks.value_bytes_)) return std::nullopt;
  if (H5Sget_simple_extent_ndims(space) != 1 || H5Pget_layout(layout) != H5D_CHUNKED ||
      H5Pget_chunk(layout, 1, &length) != 1 || length < kLeastValues || length > kMostValues)
    return std::nullopt;
  unsigned options = 0;  // of chunks that are stored as they are
  if (H5Pget_chunk_opts(layout, &options) < 0 || options != 0) return std::nullopt;
  chunks.values_ = length;
  chunks.is_signed_ = H5Tget_sign(type) == H5T_SGN_2;
  for (int i = 0; i < H5Pget_nfilters(layout); ++i) {
    unsigned flags = 0;
    std::size_t parameters = 0;
    const auto place = static_cast<unsigned>(i);
    const H5Z_filter_t filter =
        H5Pget_filter2(layout, place, &flags, &parameters, nullptr, 0, nullptr, nullptr);
    if (filter == H5Z_FILTER_SHUFFLE && !chunks.shuffle_ && !chunks.deflate_)
      chunks.shuffle_ = place;
    else if (filter == H5Z_FILTER_DEFLATE && !chunks.deflate_)
      chunks.deflate_ = place;
    else
      return std::nullopt;
  }
  return chunks;
}

bool H5Chunks::read(std::uint64_t index, Packed& packed) const {
  const hsize_t position = index * values_;
  hsize_t size = 0;
  if (H5Dget_chunk_storage_size(dataset_, &position, &size) < 0 || size == 0) return false;
  // Deflate stores what it cannot pack in blocks that are hardly longer; a damaged file may say anything.
  const std::uint64_t unpacked = values_ * value_bytes_;
  if (size > unpacked + unpacked / 8 + 1024) return false;
  packed.bytes.resize(size);
  return H5Dread_chunk(dataset_, H5P_DEFAULT, &position, &packed.skipped_filters,
                       packed.bytes.data()) >= 0;
}

bool H5Chunks::unpack(const Packed& packed, std::span<std::byte> values) const {
  SACCADE_CHECK(values.size() == values_ * value_bytes_);
  const auto is_applied = [&](const std::optional<unsigned>& filter) {
    return filter && ((packed.skipped_filters >> *filter) & 1U) == 0;
  };
  const bool is_shuffled = is_applied(shuffle_) && value_bytes_ > 1;
  std::unique_ptr<std::byte[]> inflated;
  std::span<const std::byte> bytes = packed.bytes;
  if (is_applied(deflate_)) {
    if (!is_shuffled) return unpack_zlib_exactly(bytes, values);
    inflated = std::make_unique_for_overwrite<std::byte[]>(values.size());
    const std::span memory(inflated.get(), values.size());
    if (!unpack_zlib_exactly(bytes, memory)) return false;
    bytes = memory;
  }
  if (bytes.size() != values.size()) return false;
  if (is_shuffled)
    unshuffle_bytes(bytes, value_bytes_, values);
  else
    std::ranges::copy(bytes, values.begin());
  return true;
}

void shuffle_bytes(std::span<const std::byte> values, std::size_t width,
                   std::span<std::byte> shuffled) {
  SACCADE_CHECK(values.size() == shuffled.size() && values.size() % width == 0);
  const std::size_t count = values.size() / width;
  for_width(width, [&](auto w) {
    for (std::size_t begin = 0; begin < count; begin += kPart)
      split_planes<w()>(values.data() + begin * width, std::min(kPart, count - begin),
                        shuffled.data() + begin, count);
  });
}

void unshuffle_bytes(std::span<const std::byte> shuffled, std::size_t width,
                     std::span<std::byte> values) {
  SACCADE_CHECK(values.size() == shuffled.size() && values.size() % width == 0);
  const std::size_t count = values.size() / width;
  for_width(width, [&](auto w) {
    for (std::size_t begin = 0; begin < count; begin += kPart)
      join_planes<w()>(shuffled.data() + begin, count, std::min(kPart, count - begin),
                       values.data() + begin * width);
  });
}

}  // namespace saccade
