#include "core/io/images/tga_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "core/error.h"

namespace saccade {
namespace {

/// Of the format: the lower three bits of the picture's type.
enum TgaKind : unsigned { kTgaPalette = 1, kTgaColour = 2, kTgaGrey = 3 };
constexpr unsigned kTgaRunLength = 8;
/// Pixels that one packet of a run-length encoded picture can stand for.
constexpr std::size_t kTgaLongestRun = 128;

class TgaReader {
 public:
  TgaReader(std::span<const std::byte> bytes, const std::string& location)
      : bytes_(bytes), location_(location) {}

  [[nodiscard]] unsigned u8() {
    if (position_ >= bytes_.size()) fail("ends too early");
    return std::to_integer<unsigned>(bytes_[position_++]);
  }
  [[nodiscard]] unsigned u16() {
    const unsigned low = u8();
    return low | u8() << 8U;
  }
  void skip(std::size_t count) {
    if (count > left()) fail("ends too early");
    position_ += count;
  }
  [[nodiscard]] std::size_t left() const { return bytes_.size() - position_; }
  [[noreturn]] void fail(const std::string& problem) const {
    throw InputError(location_, "is no TGA picture that can be decoded: it " + problem);
  }

 private:
  std::span<const std::byte> bytes_;
  const std::string& location_;
  std::size_t position_ = 0;
};

struct TgaHeader {
  unsigned kind = 0;
  bool is_run_length = false;
  unsigned palette_first = 0, palette_size = 0, palette_bits = 0;
  unsigned width = 0, height = 0, bits = 0;
  bool is_upside_down = false, is_mirrored = false;
  unsigned alpha_bits = 0;
};

bool is_tga_depth(unsigned bits) { return bits == 15 || bits == 16 || bits == 24 || bits == 32; }

TgaHeader read_tga_header(TgaReader& reader) {
  TgaHeader header;
  const unsigned name_length = reader.u8();
  const bool has_palette = reader.u8() == 1;
  const unsigned type = reader.u8();
  header.kind = type & ~kTgaRunLength;
  header.is_run_length = (type & kTgaRunLength) != 0;
  header.palette_first = reader.u16();
  header.palette_size = reader.u16();
  header.palette_bits = reader.u8();
  reader.skip(4);  // origin on a screen
  header.width = reader.u16();
  header.height = reader.u16();
  header.bits = reader.u8();
  const unsigned descriptor = reader.u8();
  header.alpha_bits = descriptor & 0xFU;
  header.is_mirrored = (descriptor & 0x10U) != 0;
  header.is_upside_down = (descriptor & 0x20U) == 0;
  if (header.kind < kTgaPalette || header.kind > kTgaGrey)
    reader.fail(fmt::format("has the unknown type {}", type));
  const bool is_depth_known = header.kind == kTgaColour ? is_tga_depth(header.bits)
                              : header.kind == kTgaGrey ? header.bits == 8
                                                        : header.bits == 8 || header.bits == 16;
  if (!is_depth_known) reader.fail(fmt::format("has {} bits per pixel", header.bits));
  if (header.kind == kTgaPalette && (!has_palette || !is_tga_depth(header.palette_bits)))
    reader.fail("has no palette, or one of unknown depth");
  if (header.width == 0 || header.height == 0) reader.fail("has no pixels");
  reader.skip(name_length);
  if (!has_palette) header.palette_size = 0;
  return header;
}

Rgba8 read_tga_colour(TgaReader& reader, unsigned bits, unsigned alpha_bits) {
  const auto byte = [](unsigned code) { return static_cast<std::uint8_t>(code); };
  if (bits <= 16) {
    const unsigned code = reader.u16();
    const auto five = [&](unsigned shift) {
      const unsigned value = code >> shift & 0x1FU;
      return byte(value << 3U | value >> 2U);
    };
    const bool is_clear = alpha_bits == 1 && bits == 16 && (code & 0x8000U) == 0;
    return {five(10), five(5), five(0), byte(is_clear ? 0U : 255U)};
  }
  const std::uint8_t blue = byte(reader.u8());
  const std::uint8_t green = byte(reader.u8());
  const std::uint8_t red = byte(reader.u8());
  return {red, green, blue, bits == 32 ? byte(reader.u8()) : std::uint8_t{255}};
}

std::vector<Rgba8> read_tga_palette(TgaReader& reader, const TgaHeader& header) {
  std::vector<Rgba8> palette(header.palette_size);
  for (Rgba8& colour : palette)
    colour = read_tga_colour(reader, header.palette_bits, header.alpha_bits);
  return palette;
}

Rgba8 read_tga_pixel(TgaReader& reader, const TgaHeader& header,
                     const std::vector<Rgba8>& palette) {
  if (header.kind == kTgaColour) return read_tga_colour(reader, header.bits, header.alpha_bits);
  const unsigned code = header.bits == 8 ? reader.u8() : reader.u16();
  if (header.kind == kTgaPalette) {
    if (code < header.palette_first || code - header.palette_first >= palette.size())
      reader.fail(fmt::format("has a pixel of colour {}, which is not in its palette", code));
    return palette[code - header.palette_first];
  }
  const auto grey = static_cast<std::uint8_t>(code);
  return {grey, grey, grey, 255};
}

/// In the order of the file.
std::vector<Rgba8> read_tga_pixels(TgaReader& reader, const TgaHeader& header) {
  const std::vector<Rgba8> palette = read_tga_palette(reader, header);
  const std::size_t count = std::size_t{header.width} * header.height;
  if (count > reader.left() * (header.is_run_length ? kTgaLongestRun : 1))
    reader.fail("ends too early");
  std::vector<Rgba8> pixels;
  pixels.reserve(count);
  while (pixels.size() < count) {
    if (!header.is_run_length) {
      pixels.push_back(read_tga_pixel(reader, header, palette));
      continue;
    }
    const unsigned packet = reader.u8();
    const std::size_t length = std::min<std::size_t>((packet & 0x7FU) + 1, count - pixels.size());
    if ((packet & 0x80U) != 0) {
      pixels.insert(pixels.end(), length, read_tga_pixel(reader, header, palette));
    } else {
      for (std::size_t i = 0; i < length; ++i)
        pixels.push_back(read_tga_pixel(reader, header, palette));
    }
  }
  // Many programs write a fourth byte that means nothing, and say so: no alpha bits, all zero.
  if (header.alpha_bits == 0 &&
      std::ranges::all_of(pixels, [](const Rgba8& pixel) { return pixel[3] == 0; }))
    for (Rgba8& pixel : pixels) pixel[3] = 255;
  return pixels;
}

}  // namespace

ImageRgba8 decode_tga(std::span<const std::byte> bytes, const std::string& location) {
  TgaReader reader(bytes, location);
  const TgaHeader header = read_tga_header(reader);
  const std::vector<Rgba8> pixels = read_tga_pixels(reader, header);
  const int width = static_cast<int>(header.width);
  const int height = static_cast<int>(header.height);
  ImageRgba8 image(width, height);
  std::size_t next = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      image(header.is_mirrored ? width - 1 - x : x, header.is_upside_down ? height - 1 - y : y) =
          pixels[next++];
  return image;
}

}  // namespace saccade
