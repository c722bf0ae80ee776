#include "core/io/images/tga_file.h"

#include <gmock/gmock.h>

#include "core/error.h"

namespace saccade {
namespace {

using ::testing::HasSubstr;
using TgaBytes = std::vector<unsigned char>;

/// 3 x 2 pixels; `bits` per pixel.
TgaBytes tga_header(unsigned char type, unsigned char bits, unsigned char descriptor = 0) {
  const bool has_palette = (type & 7U) == 1;
  return {0,    static_cast<unsigned char>(has_palette ? 1 : 0),
          type, 0,
          0,    static_cast<unsigned char>(has_palette ? 2 : 0),
          0,    static_cast<unsigned char>(has_palette ? 24 : 0),
          0,    0,
          0,    0,
          3,    0,
          2,    0,
          bits, descriptor};
}

TgaBytes with(TgaBytes bytes, const TgaBytes& more) {
  bytes.insert(bytes.end(), more.begin(), more.end());
  return bytes;
}

ImageRgba8 tga_image(const TgaBytes& bytes) {
  return decode_tga(std::as_bytes(std::span(bytes)), "a.tga");
}

std::string tga_error(const TgaBytes& bytes) {
  try {
    static_cast<void>(tga_image(bytes));
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

constexpr unsigned char kTopLeft = 0x20;

TEST(TgaFile, ColourIsBlueGreenRedFromTheBottomUp) {
  TgaBytes bytes = tga_header(2, 24);
  for (unsigned char i = 0; i < 18; ++i) bytes.push_back(i);
  const ImageRgba8 image = tga_image(bytes);
  ASSERT_EQ(image.width(), 3);
  ASSERT_EQ(image.height(), 2);
  EXPECT_EQ(image(0, 1), (Rgba8{2, 1, 0, 255}));
  EXPECT_EQ(image(2, 0), (Rgba8{17, 16, 15, 255}));
}

TEST(TgaFile, DescriptorTurnsThePicture) {
  const TgaBytes pixels{10, 20, 30, 40, 50, 60};
  EXPECT_EQ(tga_image(with(tga_header(3, 8, kTopLeft), pixels))(0, 0)[0], 10);
  EXPECT_EQ(tga_image(with(tga_header(3, 8, kTopLeft | 0x10), pixels))(0, 0)[0], 30);
  EXPECT_EQ(tga_image(with(tga_header(3, 8), pixels))(0, 0)[0], 40);
}

TEST(TgaFile, AlphaCountsUnlessNothingWroteIt) {
  TgaBytes clear = tga_header(2, 32, kTopLeft);
  for (int i = 0; i < 6; ++i) clear = with(clear, {1, 2, 3, 0});
  EXPECT_EQ(tga_image(clear)(1, 1), (Rgba8{3, 2, 1, 255}));
  clear[17] = kTopLeft | 8;
  EXPECT_EQ(tga_image(clear)(1, 1), (Rgba8{3, 2, 1, 0}));
  clear.back() = 128;
  clear[17] = kTopLeft;
  EXPECT_EQ(tga_image(clear)(2, 1)[3], 128);
}

TEST(TgaFile, SixteenBitsAreFiveEach) {
  TgaBytes bytes = tga_header(2, 16, kTopLeft);
  for (const unsigned code : {0x7C00U, 0x03E0U, 0x001FU, 0x7FFFU, 0x0000U, 0x4210U})
    bytes = with(
        bytes, {static_cast<unsigned char>(code & 0xFFU), static_cast<unsigned char>(code >> 8U)});
  const ImageRgba8 image = tga_image(bytes);
  EXPECT_EQ(image(0, 0), (Rgba8{255, 0, 0, 255}));
  EXPECT_EQ(image(1, 0), (Rgba8{0, 255, 0, 255}));
  EXPECT_EQ(image(2, 0), (Rgba8{0, 0, 255, 255}));
  EXPECT_EQ(image(0, 1), (Rgba8{255, 255, 255, 255}));
  EXPECT_EQ(image(2, 1), (Rgba8{132, 132, 132, 255}));
}

TEST(TgaFile, RunsAreRepeatedAndCrossRows) {
  const TgaBytes bytes =
      with(tga_header(10, 24, kTopLeft), {0x83, 1, 2, 3, 0x01, 4, 5, 6, 7, 8, 9});
  const ImageRgba8 image = tga_image(bytes);
  EXPECT_EQ(image(0, 1), (Rgba8{3, 2, 1, 255}));
  EXPECT_EQ(image(1, 1), (Rgba8{6, 5, 4, 255}));
  EXPECT_EQ(image(2, 1), (Rgba8{9, 8, 7, 255}));
  EXPECT_EQ(tga_image(with(tga_header(11, 8, kTopLeft), {0x85, 77}))(2, 1)[1], 77);
}

TEST(TgaFile, PalettesAreLookedUp) {
  const TgaBytes palette{1, 2, 3, 4, 5, 6};
  const ImageRgba8 image =
      tga_image(with(with(tga_header(1, 8, kTopLeft), palette), {0, 1, 0, 1, 1, 0}));
  EXPECT_EQ(image(1, 0), (Rgba8{6, 5, 4, 255}));
  EXPECT_EQ(image(2, 1), (Rgba8{3, 2, 1, 255}));
  EXPECT_THAT(tga_error(with(with(tga_header(1, 8), palette), {0, 1, 2, 0, 0, 0})),
              HasSubstr("not in its palette"));
}

TEST(TgaFile, MalformedFilesAreErrors) {
  TgaBytes whole = tga_header(2, 24);
  whole.resize(18 + 18, 7);
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_THAT(tga_error({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)}),
                HasSubstr("a.tga"))
        << size;
  EXPECT_THAT(tga_error(tga_header(7, 24)), HasSubstr("type 7"));
  EXPECT_THAT(tga_error(tga_header(2, 12)), HasSubstr("12 bits"));
  TgaBytes empty = tga_header(2, 24);
  empty[12] = 0;
  EXPECT_THAT(tga_error(empty), HasSubstr("no pixels"));
  TgaBytes huge = with(tga_header(10, 24), {0xFF, 1, 2, 3});
  huge[13] = huge[15] = 0xFF;
  EXPECT_THAT(tga_error(huge), HasSubstr("ends too early"));
}

}  // namespace
}  // namespace saccade
