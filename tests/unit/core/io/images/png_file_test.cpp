#include "core/io/images/png_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <png.h>

#include <vector>

#include "tests/support/damage.h"
#include "tests/support/error_of.h"

namespace saccade {
namespace {

using testing::error_of;
using ::testing::HasSubstr;

std::span<const std::byte> png_bytes(const std::string& file) {
  return std::as_bytes(std::span(file));
}

struct PngKind {
  int color_type;
  int bit_depth;
  bool is_interlaced = false;
  bool has_clear_colour = false;  ///< the code 1, of palettes the colour 1
};

constexpr std::array<png_color, 2> kPngPalette{png_color{10, 20, 30}, png_color{200, 100, 50}};

/// A picture of another writer: `rows` as the format packs them.
std::string png_of(const PngKind& kind, std::uint32_t width, std::vector<std::string> rows) {
  std::string file;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_set_write_fn(
      png, &file,
      [](png_structp p, png_bytep bytes, std::size_t count) {
        static_cast<std::string*>(png_get_io_ptr(p))
            ->append(reinterpret_cast<const char*>(bytes), count);
      },
      nullptr);
  png_set_IHDR(png, info, width, static_cast<std::uint32_t>(rows.size()), kind.bit_depth,
               kind.color_type, kind.is_interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  const bool has_palette = kind.color_type == PNG_COLOR_TYPE_PALETTE;
  if (has_palette) png_set_PLTE(png, info, kPngPalette.data(), kPngPalette.size());
  constexpr std::array<png_byte, 2> kAlpha{255, 0};
  constexpr png_color_16 kClear{1, 1, 1, 1, 1};
  if (kind.has_clear_colour)
    png_set_tRNS(png, info, has_palette ? kAlpha.data() : nullptr, has_palette ? 2 : 0, &kClear);
  png_write_info(png, info);
  std::vector<png_bytep> pointers;
  pointers.reserve(rows.size());
  for (std::string& row : rows) pointers.push_back(reinterpret_cast<png_bytep>(row.data()));
  png_write_image(png, pointers.data());
  png_write_end(png, nullptr);
  png_destroy_write_struct(&png, &info);
  return file;
}

ImageRgba8 png_rgba(const std::string& file) { return decode_png_rgba(png_bytes(file), "a.png"); }
ImageRgb8 png_rgb(const std::string& file) { return decode_png_rgb(png_bytes(file), "a.png"); }
ImageU8 png_grey(const std::string& file) { return decode_png_grey(png_bytes(file), "a.png"); }

TEST(PngFile, FewBitsOfGreyReachFromBlackToWhite) {
  for (const int bits : {1, 2, 4, 8}) {
    const int most = (1 << bits) - 1;
    const std::string row(1, static_cast<char>(most << (8 - bits)));  // white, then black
    const std::string file = png_of({PNG_COLOR_TYPE_GRAY, bits}, bits == 8 ? 1 : 2, {row});
    EXPECT_EQ(png_grey(file)(0, 0), 255) << bits;
    EXPECT_EQ(png_rgb(file)(0, 0), (Rgb8{255, 255, 255})) << bits;
    EXPECT_EQ(png_rgba(file)(0, 0), (Rgba8{255, 255, 255, 255})) << bits;
    if (bits < 8) {
      EXPECT_EQ(png_grey(file)(1, 0), 0) << bits;
    }
  }
  EXPECT_EQ(png_grey(png_of({PNG_COLOR_TYPE_GRAY, 4}, 1, {"\x50"}))(0, 0), 0x55);
}

TEST(PngFile, PalettesBecomeColours) {
  for (const bool is_clear : {false, true}) {
    const std::string file = png_of({PNG_COLOR_TYPE_PALETTE, 1, false, is_clear}, 2, {"\x40"});
    EXPECT_EQ(png_rgba(file)(0, 0), (Rgba8{10, 20, 30, 255}));
    EXPECT_EQ(png_rgba(file)(1, 0),
              (Rgba8{200, 100, 50, static_cast<std::uint8_t>(is_clear ? 0 : 255)}));
    EXPECT_EQ(png_rgb(file)(1, 0), (Rgb8{200, 100, 50}));
    EXPECT_NEAR(png_grey(file)(1, 0), 0.299 * 200 + 0.587 * 100 + 0.114 * 50, 1);
  }
}

TEST(PngFile, AlphaOfEveryKind) {
  EXPECT_EQ(png_rgba(png_of({PNG_COLOR_TYPE_GRAY_ALPHA, 8}, 1, {"\x20\x30"}))(0, 0),
            (Rgba8{0x20, 0x20, 0x20, 0x30}));
  EXPECT_EQ(png_rgba(png_of({PNG_COLOR_TYPE_RGBA, 8}, 1, {"\x01\x02\x03\x04"}))(0, 0),
            (Rgba8{1, 2, 3, 4}));
  const std::string file =
      png_of({PNG_COLOR_TYPE_RGB, 8, false, true}, 2, {"\x01\x01\x01\x01\x02\x01"});
  EXPECT_EQ(png_rgba(file)(0, 0), (Rgba8{1, 1, 1, 0}));
  EXPECT_EQ(png_rgba(file)(1, 0), (Rgba8{1, 2, 1, 255}));
  EXPECT_EQ(png_rgba(png_of({PNG_COLOR_TYPE_GRAY, 8, false, true}, 1, {"\x01"}))(0, 0),
            (Rgba8{1, 1, 1, 0}));
}

TEST(PngFile, SixteenBitsLoseTheirLowByteOrAreRounded) {
  const std::string file =
      png_of({PNG_COLOR_TYPE_GRAY, 16}, 3, {std::string("\x12\x7F\x12\xFF\xFF\xFF")});
  EXPECT_EQ(png_grey(file)(0, 0), 0x12);
  EXPECT_EQ(png_grey(file)(1, 0), 0x12);
  EXPECT_EQ(png_rgb(file)(1, 0), (Rgb8{0x12, 0x12, 0x12}));
  EXPECT_EQ(png_rgba(file)(0, 0), (Rgba8{0x12, 0x12, 0x12, 255}));
  EXPECT_EQ(png_rgba(file)(1, 0), (Rgba8{0x13, 0x13, 0x13, 255}));
  EXPECT_EQ(png_rgba(file)(2, 0), (Rgba8{255, 255, 255, 255}));
  EXPECT_EQ(decode_png_u16(png_bytes(file), "a.png")(1, 0), 0x12FF);
}

TEST(PngFile, InterlacedPicturesAreTheSame) {
  std::vector<std::string> rows;
  for (int y = 0; y < 11; ++y) {
    rows.emplace_back();
    for (int x = 0; x < 3 * 13; ++x) rows.back() += static_cast<char>(17 * x + 31 * y);
  }
  const ImageRgb8 plain = png_rgb(png_of({PNG_COLOR_TYPE_RGB, 8}, 13, rows));
  EXPECT_EQ(plain(2, 1), (Rgb8{133, 150, 167}));
  EXPECT_EQ(png_rgb(png_of({PNG_COLOR_TYPE_RGB, 8, true}, 13, rows)), plain);
}

TEST(PngFile, WrittenPicturesOfEveryKindReadBack) {
  ImageRgba8 image(3, 2, Rgba8{1, 2, 3, 4});
  image(2, 1) = {255, 0, 128, 7};
  EXPECT_EQ(png_rgba(encode_png(image)), image);
  ImageU16 codes(5, 2, 0x1234);
  codes(4, 1) = 65535;
  EXPECT_EQ(decode_png_u16(png_bytes(encode_png(codes)), "a.png"), codes);
  EXPECT_THAT(
      error_of([&] { return decode_png_u16(png_bytes(encode_png(ImageU8(2, 2, 9))), "a.png"); }),
      HasSubstr("a.png: is no picture of one channel of 16 bits"));
  ImageRgb16 vectors(2, 3, Rgb16{0x1234, 7, 65535});
  vectors(1, 2) = {1, 0x8000, 3};
  EXPECT_EQ(decode_png_rgb16(png_bytes(encode_png(vectors)), "a.png"), vectors);
  EXPECT_THAT(error_of([&] { return decode_png_rgb16(png_bytes(encode_png(codes)), "a.png"); }),
              HasSubstr("a.png: is no picture of three channels of 16 bits"));
}

TEST(PngFile, DamageIsAnError) {
  const std::string file = png_of({PNG_COLOR_TYPE_RGB, 8, true}, 2,
                                  {"\x01\x02\x03\x04\x05\x06", "\x07\x08\x09\x10\x11\x12"});
  testing::expect_damage_is_reported(file, file.size(), png_rgba);
  testing::expect_damage_is_reported(file, file.size(), png_grey);
  EXPECT_THAT(error_of([&] { return png_rgb(file.substr(0, 50)); }), HasSubstr("ends too early"));
  EXPECT_THAT(error_of([&] { return png_rgb(file.substr(0, 50)); }), HasSubstr("a.png"));
}

/// The first bytes of a picture of the stated size, with the checksum that belongs to them.
std::string huge_png_header(std::uint32_t width, std::uint32_t height) {
  std::string file = png_of({PNG_COLOR_TYPE_GRAY, 8}, 1, {"\x01"});
  std::string chunk = "IHDR";
  for (const std::uint32_t number : {width, height})
    for (int shift = 24; shift >= 0; shift -= 8) chunk += static_cast<char>(number >> shift);
  chunk += file.substr(24, 5);
  std::uint32_t crc = ~0U;
  for (const char c : chunk) {
    crc ^= static_cast<std::uint8_t>(c);
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1U ^ ((crc & 1U) != 0 ? 0xEDB88320U : 0U);
  }
  for (int shift = 24; shift >= 0; shift -= 8) chunk += static_cast<char>(~crc >> shift);
  return file.substr(0, 12) + chunk + file.substr(33);
}

TEST(PngFile, AHeaderAloneTakesNoMemory) {
  EXPECT_EQ(png_rgb(huge_png_header(1, 1))(0, 0), (Rgb8{1, 1, 1}));
  EXPECT_THAT(error_of([] { return png_rgb(huge_png_header(20000, 20000)); }),
              HasSubstr("ends too early"));
  EXPECT_THAT(error_of([] { return png_rgb(huge_png_header(1000000, 1000000)); }),
              HasSubstr("a.png: is a picture of 1000000 x 1000000 pixels; at most 536870912"));
  EXPECT_THAT(error_of([] { return png_rgb(huge_png_header(2000000000, 1)); }),
              HasSubstr("a.png: is no PNG"));
}

}  // namespace
}  // namespace saccade
