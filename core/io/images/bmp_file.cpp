#include "core/io/images/bmp_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "core/io/images/picture_bytes.h"

namespace saccade {
namespace {

// Microsoft, "Bitmap Storage" and "BITMAPV5HEADER structure".
constexpr std::size_t kBmpFileHeader = 14;
constexpr std::uint32_t kBmpCoreHeader = 12, kBmpInfoHeader = 40, kBmpHeaderWithAlpha = 56;
enum BmpCompression : std::uint32_t { kBmpPlain = 0, kBmpRuns8 = 1, kBmpRuns4 = 2, kBmpMasks = 3 };

struct BmpLayout {
  int width = 0, height = 0;
  bool is_upside_down = true;
  unsigned bits = 0;  ///< per pixel
  std::uint32_t compression = kBmpPlain;
  std::array<std::uint32_t, 4> masks{0xFF0000U, 0xFF00U, 0xFFU, 0};
  std::vector<Rgba8> palette;
  std::size_t start = 0;
};

void read_bmp_palette(const PictureBytes& bytes, std::size_t at, std::uint32_t count,
                      std::size_t entry_size, BmpLayout& layout) {
  const std::uint32_t most = 1U << layout.bits;
  if (count > most) bytes.fail(fmt::format("has {} colours", count));
  // Codes above the last colour are black.
  layout.palette.assign(most, Rgba8{0, 0, 0, 255});
  for (std::uint32_t i = 0; i < (count > 0 ? count : most); ++i, at += entry_size)
    for (std::size_t k = 0; k < 3; ++k)
      layout.palette[i][k] = static_cast<std::uint8_t>(bytes.u8(at + 2 - k));
}

void read_bmp_masks(const PictureBytes& bytes, std::uint32_t header_size, BmpLayout& layout) {
  if (layout.bits == 16) layout.masks = {0x7C00U, 0x3E0U, 0x1FU, 0};
  if (layout.compression != kBmpMasks) return;
  const std::size_t count = header_size >= kBmpHeaderWithAlpha ? 4 : 3;
  for (std::size_t k = 0; k < count; ++k)
    layout.masks[k] = bytes.u32(kBmpFileHeader + kBmpInfoHeader + 4 * k);
}

bool is_bmp_known(const BmpLayout& layout) {
  switch (layout.compression) {
    case kBmpPlain:
      return layout.bits == 1 || layout.bits == 4 || layout.bits == 8 || layout.bits == 16 ||
             layout.bits == 24 || layout.bits == 32;
    case kBmpRuns8:
      return layout.bits == 8;
    case kBmpRuns4:
      return layout.bits == 4;
    case kBmpMasks:
      return layout.bits == 16 || layout.bits == 32;
    default:
      return false;
  }
}

BmpLayout read_bmp_layout(const PictureBytes& bytes, const std::string& location) {
  BmpLayout layout;
  layout.start = bytes.u32(10);
  const std::uint32_t header_size = bytes.u32(kBmpFileHeader);
  const bool is_core = header_size == kBmpCoreHeader;
  if (!is_core && header_size < kBmpInfoHeader) bytes.fail("has an unknown header");
  const std::int64_t width =
      is_core ? std::int64_t{bytes.u16(18)} : static_cast<std::int32_t>(bytes.u32(18));
  const std::int64_t height =
      is_core ? std::int64_t{bytes.u16(20)} : static_cast<std::int32_t>(bytes.u32(22));
  layout.bits = bytes.u16(is_core ? 24 : 28);
  layout.compression = is_core ? kBmpPlain : bytes.u32(30);
  if (!is_bmp_known(layout))
    bytes.fail(fmt::format("has {} bits per pixel in the compression {}", layout.bits,
                           layout.compression));
  check_picture_size(static_cast<std::uint64_t>(std::max<std::int64_t>(width, 0)),
                     static_cast<std::uint64_t>(height < 0 ? -height : height), bytes.size(),
                     location);
  layout.width = static_cast<int>(width);
  layout.height = static_cast<int>(height < 0 ? -height : height);
  layout.is_upside_down = height > 0;
  if (layout.bits <= 8)
    read_bmp_palette(bytes, kBmpFileHeader + header_size, is_core ? 0 : bytes.u32(46),
                     is_core ? 3 : 4, layout);
  else
    read_bmp_masks(bytes, header_size, layout);
  return layout;
}

/// The part of `code` under `mask` as the upper bits of a byte.
std::uint8_t bmp_masked(std::uint32_t code, std::uint32_t mask) {
  if (mask == 0) return 0;
  const std::uint32_t value = (code & mask) >> std::countr_zero(mask);
  const int bits = std::popcount(mask);
  return static_cast<std::uint8_t>(bits >= 8 ? value >> (bits - 8) : value << (8 - bits));
}

Rgba8 bmp_colour(const BmpLayout& layout, std::uint32_t code) {
  const std::uint32_t alpha = layout.masks[3];
  return {bmp_masked(code, layout.masks[0]), bmp_masked(code, layout.masks[1]),
          bmp_masked(code, layout.masks[2]),
          alpha != 0 ? bmp_masked(code, alpha) : std::uint8_t{255}};
}

void read_bmp_row(const PictureBytes& bytes, const BmpLayout& layout, std::size_t at,
                  Rgba8* pixels) {
  for (unsigned x = 0; x < static_cast<unsigned>(layout.width); ++x) {
    if (layout.bits <= 8) {
      const unsigned first_bit = x * layout.bits;
      const unsigned shift = 8 - layout.bits - first_bit % 8;
      const unsigned code = bytes.u8(at + first_bit / 8) >> shift & ((1U << layout.bits) - 1);
      pixels[x] = layout.palette[code];
      continue;
    }
    const std::size_t p = at + x * (layout.bits / 8);
    const std::uint32_t code = layout.bits == 16   ? bytes.u16(p)
                               : layout.bits == 24 ? bytes.u16(p) | bytes.u8(p + 2) << 16U
                                                   : bytes.u32(p);
    pixels[x] = bmp_colour(layout, code);
  }
}

/// The picture with its rows in the order of the file. Pixels that are jumped over have colour 0.
ImageRgba8 read_bmp_runs(const PictureBytes& bytes, const BmpLayout& layout) {
  ImageRgba8 image(layout.width, layout.height, layout.palette[0]);
  const bool is_half = layout.compression == kBmpRuns4;
  std::size_t at = layout.start;
  int x = 0, y = 0;
  const auto put = [&](unsigned code) {
    if (x >= layout.width || y >= layout.height) bytes.fail("has a run beyond its border");
    image(x++, y) = layout.palette[code];
  };
  while (true) {
    const unsigned count = bytes.u8(at);
    const unsigned value = bytes.u8(at + 1);
    at += 2;
    if (count > 0) {
      for (unsigned i = 0; i < count; ++i)
        put(is_half ? (i % 2 == 0 ? value >> 4U : value & 15U) : value);
    } else if (value == 0) {
      x = 0;
      if (++y > layout.height) bytes.fail("has a row beyond its border");
    } else if (value == 1) {
      return image;
    } else if (value == 2) {
      x += static_cast<int>(bytes.u8(at));
      y += static_cast<int>(bytes.u8(at + 1));
      at += 2;
      if (x > layout.width || y > layout.height) bytes.fail("has a jump beyond its border");
    } else {
      for (unsigned i = 0; i < value; ++i) {
        const unsigned byte = bytes.u8(at + (is_half ? i / 2 : i));
        put(is_half ? (i % 2 == 0 ? byte >> 4U : byte & 15U) : byte);
      }
      const unsigned size = is_half ? (value + 1) / 2 : value;
      at += size + size % 2;
    }
  }
}

ImageRgba8 read_bmp_pixels(const PictureBytes& bytes, const BmpLayout& layout) {
  if (layout.compression == kBmpRuns8 || layout.compression == kBmpRuns4)
    return read_bmp_runs(bytes, layout);
  const std::size_t row =
      (std::size_t{layout.bits} * static_cast<unsigned>(layout.width) + 31) / 32 * 4;
  if (row * static_cast<unsigned>(layout.height) > bytes.left(layout.start))
    bytes.fail("ends too early");
  ImageRgba8 image(layout.width, layout.height);
  for (int y = 0; y < layout.height; ++y)
    read_bmp_row(bytes, layout, layout.start + row * static_cast<unsigned>(y), &image(0, y));
  return image;
}

}  // namespace

bool is_bmp(std::span<const std::byte> bytes) { return begins_with(bytes, "BM"); }

ImageRgba8 decode_bmp(std::span<const std::byte> bytes, const std::string& location) {
  const PictureBytes source(bytes, location, "BMP");
  const BmpLayout layout = read_bmp_layout(source, location);
  ImageRgba8 image = read_bmp_pixels(source, layout);
  if (layout.is_upside_down)
    for (int y = 0; y < image.height() / 2; ++y)
      std::swap_ranges(&image(0, y), &image(0, y) + image.width(),
                       &image(0, image.height() - 1 - y));
  return image;
}

}  // namespace saccade
