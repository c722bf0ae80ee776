#include "core/io/images/dds_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <optional>
#include <string_view>

#include "core/error.h"

namespace saccade {
namespace {

// Microsoft, "Programming Guide for DDS" and "Texture Block Compression in Direct3D 11".
constexpr std::string_view kDdsMagic = "DDS ";
constexpr std::size_t kDdsHeaderEnd = 128;
constexpr std::size_t kDdsSecondHeaderEnd = 148;
constexpr std::uint32_t kDdsMostSide = 65536;

enum class DdsBlocks { kNone, kBc1, kBc2, kBc3 };

struct DdsLayout {
  std::uint32_t width = 0, height = 0;
  DdsBlocks blocks = DdsBlocks::kNone;
  std::uint32_t bits = 0;  ///< per pixel, uncompressed
  std::array<std::uint32_t, 4> masks{};
  std::size_t start = kDdsHeaderEnd;
};

class DdsBytes {
 public:
  DdsBytes(std::span<const std::byte> bytes, const std::string& location)
      : bytes_(bytes), location_(location) {}

  [[nodiscard]] std::uint32_t u8(std::size_t at) const {
    if (at >= bytes_.size()) fail("ends too early");
    return std::to_integer<std::uint32_t>(bytes_[at]);
  }
  /// Little-endian, of 1 to 8 bytes.
  [[nodiscard]] std::uint64_t number(std::size_t at, std::size_t size) const {
    std::uint64_t value = 0;
    for (std::size_t i = size; i-- > 0;) value = value << 8U | u8(at + i);
    return value;
  }
  [[nodiscard]] std::uint32_t u32(std::size_t at) const {
    return static_cast<std::uint32_t>(number(at, 4));
  }
  [[nodiscard]] std::size_t size() const { return bytes_.size(); }
  [[noreturn]] void fail(const std::string& problem) const {
    throw InputError(location_, "is no DDS picture that can be decoded: it " + problem);
  }

 private:
  std::span<const std::byte> bytes_;
  const std::string& location_;
};

std::optional<DdsBlocks> dds_blocks_of(std::string_view four_letters) {
  if (four_letters == "DXT1") return DdsBlocks::kBc1;
  if (four_letters == "DXT3") return DdsBlocks::kBc2;
  if (four_letters == "DXT5") return DdsBlocks::kBc3;
  return std::nullopt;
}

/// The formats of a second header (DXGI_FORMAT) that a first one could state as well.
bool take_dxgi_format(std::uint32_t format, DdsLayout& layout) {
  switch (format) {
    case 71:
    case 72:
      layout.blocks = DdsBlocks::kBc1;
      return true;
    case 74:
    case 75:
      layout.blocks = DdsBlocks::kBc2;
      return true;
    case 77:
    case 78:
      layout.blocks = DdsBlocks::kBc3;
      return true;
    case 28:
    case 29:
      layout.masks = {0xFFU, 0xFF00U, 0xFF0000U, 0xFF000000U};
      break;
    case 87:
    case 91:
      layout.masks = {0xFF0000U, 0xFF00U, 0xFFU, 0xFF000000U};
      break;
    case 88:
    case 93:
      layout.masks = {0xFF0000U, 0xFF00U, 0xFFU, 0};
      break;
    default:
      return false;
  }
  layout.bits = 32;
  return true;
}

void take_dds_masks(const DdsBytes& bytes, std::uint32_t flags, DdsLayout& layout) {
  constexpr std::uint32_t kAlpha = 0x1U, kRgb = 0x40U, kGrey = 0x20000U;
  layout.bits = bytes.u32(88);
  layout.masks = {bytes.u32(92), bytes.u32(96), bytes.u32(100), bytes.u32(104)};
  if ((flags & kGrey) != 0) layout.masks[1] = layout.masks[2] = layout.masks[0];
  if ((flags & kAlpha) == 0) layout.masks[3] = 0;
  if ((flags & (kGrey | kRgb)) == 0 || layout.bits % 8 != 0 || layout.bits == 0 || layout.bits > 32)
    bytes.fail(fmt::format("is of neither grey nor RGB, with {} bits per pixel", layout.bits));
}

DdsLayout read_dds_layout(const DdsBytes& bytes) {
  constexpr std::uint32_t kFourLetters = 0x4U;
  if (bytes.size() < kDdsHeaderEnd) bytes.fail("ends too early");
  DdsLayout layout;
  layout.height = bytes.u32(12);
  layout.width = bytes.u32(16);
  if (layout.width == 0 || layout.height == 0 || layout.width > kDdsMostSide ||
      layout.height > kDdsMostSide)
    bytes.fail(fmt::format("has {} x {} pixels", layout.width, layout.height));
  const std::uint32_t flags = bytes.u32(80);
  if ((flags & kFourLetters) == 0) {
    take_dds_masks(bytes, flags, layout);
    return layout;
  }
  std::string letters;
  for (std::size_t i = 84; i < 88; ++i) {
    const auto letter = static_cast<char>(bytes.u8(i));
    letters += letter >= ' ' && letter <= '~' ? letter : '?';
  }
  if (letters == "DX10") {
    layout.start = kDdsSecondHeaderEnd;
    const std::uint32_t format = bytes.u32(kDdsHeaderEnd);
    if (!take_dxgi_format(format, layout))
      bytes.fail(fmt::format("is of the format DXGI {}; BC1, BC2, BC3 and 8-bit RGBA can be read",
                             format));
    return layout;
  }
  const std::optional<DdsBlocks> blocks = dds_blocks_of(letters);
  if (!blocks)
    bytes.fail(
        fmt::format("is of the format {}; DXT1, DXT3, DXT5 and plain RGBA can be read", letters));
  layout.blocks = *blocks;
  return layout;
}

std::uint8_t dds_byte(std::uint64_t value) { return static_cast<std::uint8_t>(value); }

/// The part of `code` under `mask`, stretched to 0..255.
std::uint8_t dds_masked(std::uint64_t code, std::uint32_t mask) {
  const std::uint64_t most = mask >> std::countr_zero(mask);
  const std::uint64_t value = (code & mask) >> std::countr_zero(mask);
  return dds_byte((value * 255 + most / 2) / most);
}

ImageRgba8 read_dds_pixels(const DdsBytes& bytes, const DdsLayout& layout) {
  const std::size_t size = layout.bits / 8;
  if (std::size_t{layout.width} * layout.height * size > bytes.size() - layout.start)
    bytes.fail("ends too early");
  ImageRgba8 image(static_cast<int>(layout.width), static_cast<int>(layout.height));
  std::size_t at = layout.start;
  for (Rgba8& pixel : image.pixels()) {
    const std::uint64_t code = bytes.number(at, size);
    for (std::size_t k = 0; k < 4; ++k)
      pixel[k] =
          layout.masks[k] != 0 ? dds_masked(code, layout.masks[k]) : dds_byte(k == 3 ? 255U : 0U);
    at += size;
  }
  return image;
}

using DdsBlock = std::array<Rgba8, 16>;

Rgba8 dds_rgb565(std::uint64_t code) {
  return {dds_masked(code, 0xF800U), dds_masked(code, 0x7E0U), dds_masked(code, 0x1FU), 255};
}

/// (a first + b second) / (a + b)
Rgba8 dds_mixed(const Rgba8& first, const Rgba8& second, unsigned a, unsigned b) {
  Rgba8 mixed{0, 0, 0, 255};
  for (std::size_t k = 0; k < 3; ++k)
    mixed[k] = dds_byte((a * first[k] + b * second[k] + (a + b) / 2) / (a + b));
  return mixed;
}

/// Eight bytes of colour. `has_clear`: where the first is not above the second, code 3 is no
/// colour.
DdsBlock read_dds_colours(const DdsBytes& bytes, std::size_t at, bool has_clear) {
  const std::uint64_t first = bytes.number(at, 2);
  const std::uint64_t second = bytes.number(at + 2, 2);
  const std::uint64_t codes = bytes.number(at + 4, 4);
  std::array<Rgba8, 4> palette{dds_rgb565(first), dds_rgb565(second)};
  const bool is_clear = has_clear && first <= second;
  palette[2] =
      is_clear ? dds_mixed(palette[0], palette[1], 1, 1) : dds_mixed(palette[0], palette[1], 2, 1);
  palette[3] = is_clear ? Rgba8{0, 0, 0, 0} : dds_mixed(palette[0], palette[1], 1, 2);
  DdsBlock block;
  for (std::size_t i = 0; i < block.size(); ++i) block[i] = palette[codes >> 2 * i & 3U];
  return block;
}

/// Eight bytes: four bits of alpha each.
void read_dds_plain_alpha(const DdsBytes& bytes, std::size_t at, DdsBlock& block) {
  const std::uint64_t codes = bytes.number(at, 8);
  for (std::size_t i = 0; i < block.size(); ++i)
    block[i][3] = dds_byte((codes >> 4 * i & 15U) * 17);
}

/// Eight bytes: two ends and three bits each between them.
void read_dds_mixed_alpha(const DdsBytes& bytes, std::size_t at, DdsBlock& block) {
  const unsigned first = bytes.u8(at);
  const unsigned second = bytes.u8(at + 1);
  const std::uint64_t codes = bytes.number(at + 2, 6);
  const unsigned parts = first > second ? 7 : 5;
  for (std::size_t i = 0; i < block.size(); ++i) {
    const auto code = static_cast<unsigned>(codes >> 3 * i & 7U);
    unsigned alpha = code == 0 ? first : second;
    if (code > parts) {
      alpha = code == 6 ? 0 : 255;
    } else if (code > 1) {
      alpha = ((parts + 1 - code) * first + (code - 1) * second + parts / 2) / parts;
    }
    block[i][3] = dds_byte(alpha);
  }
}

ImageRgba8 read_dds_blocks(const DdsBytes& bytes, const DdsLayout& layout) {
  const std::size_t size = layout.blocks == DdsBlocks::kBc1 ? 8 : 16;
  const std::size_t across = (layout.width + 3) / 4;
  const std::size_t down = (layout.height + 3) / 4;
  if (bytes.size() < layout.start || across * down * size > bytes.size() - layout.start)
    bytes.fail("ends too early");
  ImageRgba8 image(static_cast<int>(layout.width), static_cast<int>(layout.height));
  for (std::size_t j = 0; j < down; ++j)
    for (std::size_t i = 0; i < across; ++i) {
      const std::size_t at = layout.start + (j * across + i) * size;
      const bool is_bc1 = layout.blocks == DdsBlocks::kBc1;
      DdsBlock block = read_dds_colours(bytes, is_bc1 ? at : at + 8, is_bc1);
      if (layout.blocks == DdsBlocks::kBc2) read_dds_plain_alpha(bytes, at, block);
      if (layout.blocks == DdsBlocks::kBc3) read_dds_mixed_alpha(bytes, at, block);
      for (std::size_t k = 0; k < block.size(); ++k) {
        const std::size_t x = 4 * i + k % 4;
        const std::size_t y = 4 * j + k / 4;
        if (x < layout.width && y < layout.height)
          image(static_cast<int>(x), static_cast<int>(y)) = block[k];
      }
    }
  return image;
}

}  // namespace

bool is_dds(std::span<const std::byte> bytes) {
  return bytes.size() >= kDdsMagic.size() &&
         std::ranges::equal(bytes.first(kDdsMagic.size()), kDdsMagic,
                            [](std::byte a, char b) { return static_cast<char>(a) == b; });
}

ImageRgba8 decode_dds(std::span<const std::byte> bytes, const std::string& location) {
  const DdsBytes source(bytes, location);
  if (!is_dds(bytes)) source.fail("does not begin with 'DDS '");
  const DdsLayout layout = read_dds_layout(source);
  if (source.size() < layout.start) source.fail("ends too early");
  return layout.blocks == DdsBlocks::kNone ? read_dds_pixels(source, layout)
                                           : read_dds_blocks(source, layout);
}

}  // namespace saccade
