#include "core/io/images/dds_file.h"

#include <gmock/gmock.h>

#include <array>
#include <cstdint>

#include "core/error.h"

namespace saccade {
namespace {

using ::testing::HasSubstr;
using DdsFileBytes = std::vector<unsigned char>;

void put(DdsFileBytes& bytes, std::size_t at, std::uint32_t value) {
  for (std::size_t i = 0; i < 4; ++i)
    bytes.at(at + i) = static_cast<unsigned char>(value >> 8 * i & 0xFFU);
}

DdsFileBytes dds_header(std::uint32_t width, std::uint32_t height) {
  DdsFileBytes bytes(128);
  std::copy_n("DDS ", 4, bytes.begin());
  put(bytes, 4, 124);
  put(bytes, 12, height);
  put(bytes, 16, width);
  put(bytes, 76, 32);
  return bytes;
}

DdsFileBytes dds_blocks(const char* format, std::uint32_t width, std::uint32_t height) {
  DdsFileBytes bytes = dds_header(width, height);
  put(bytes, 80, 4);
  std::copy_n(format, 4, bytes.begin() + 84);
  return bytes;
}

DdsFileBytes dds_plain(std::uint32_t bits, const std::array<std::uint32_t, 4>& masks) {
  DdsFileBytes bytes = dds_header(2, 1);
  put(bytes, 80, masks[3] != 0 ? 0x41 : 0x40);
  put(bytes, 88, bits);
  for (std::size_t k = 0; k < 4; ++k) put(bytes, 92 + 4 * k, masks[k]);
  return bytes;
}

DdsFileBytes with_more(DdsFileBytes bytes, const DdsFileBytes& more) {
  bytes.insert(bytes.end(), more.begin(), more.end());
  return bytes;
}

ImageRgba8 dds_image(const DdsFileBytes& bytes) {
  return decode_dds(std::as_bytes(std::span(bytes)), "a.dds");
}

std::string dds_error(const DdsFileBytes& bytes) {
  try {
    static_cast<void>(dds_image(bytes));
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

/// Red and blue, first above second: codes 0, 1, 2, 3 in the first row, 0 below.
const DdsFileBytes kRedBlue{0x00, 0xF8, 0x1F, 0x00, 0xE4, 0, 0, 0};
/// The same with blue first, so that code 3 is clear.
const DdsFileBytes kBlueRed{0x1F, 0x00, 0x00, 0xF8, 0xE4, 0, 0, 0};

TEST(DdsFile, Bc1MixesTwoColours) {
  const ImageRgba8 image = dds_image(with_more(dds_blocks("DXT1", 4, 4), kRedBlue));
  EXPECT_EQ(image(0, 0), (Rgba8{255, 0, 0, 255}));
  EXPECT_EQ(image(1, 0), (Rgba8{0, 0, 255, 255}));
  EXPECT_EQ(image(2, 0), (Rgba8{170, 0, 85, 255}));
  EXPECT_EQ(image(3, 0), (Rgba8{85, 0, 170, 255}));
  EXPECT_EQ(image(3, 3), (Rgba8{255, 0, 0, 255}));
}

TEST(DdsFile, Bc1CanBeClear) {
  const ImageRgba8 image = dds_image(with_more(dds_blocks("DXT1", 4, 4), kBlueRed));
  EXPECT_EQ(image(2, 0), (Rgba8{128, 0, 128, 255}));
  EXPECT_EQ(image(3, 0), (Rgba8{0, 0, 0, 0}));
}

TEST(DdsFile, Bc2StatesAlphaPlainly) {
  const DdsFileBytes alpha{0x10, 0x32, 0x54, 0x76, 0x98, 0xBA, 0xDC, 0xFE};
  const ImageRgba8 image =
      dds_image(with_more(with_more(dds_blocks("DXT3", 4, 4), alpha), kBlueRed));
  EXPECT_EQ(image(0, 0)[3], 0);
  EXPECT_EQ(image(1, 0)[3], 17);
  EXPECT_EQ(image(3, 3)[3], 255);
  EXPECT_EQ(image(3, 0)[0], 170) << "code 3 is a colour beside an alpha block";
}

TEST(DdsFile, Bc3MixesAlpha) {
  // Codes 0, 1, 2, 7 in the first row.
  const std::uint32_t codes = 0U | 1U << 3U | 2U << 6U | 7U << 9U;
  const auto code_byte = [&](unsigned i) {
    return static_cast<unsigned char>(codes >> 8 * i & 0xFFU);
  };
  const DdsFileBytes falling{210, 0, code_byte(0), code_byte(1), 0, 0, 0, 0};
  ImageRgba8 image = dds_image(with_more(with_more(dds_blocks("DXT5", 4, 4), falling), kRedBlue));
  EXPECT_EQ(image(0, 0)[3], 210);
  EXPECT_EQ(image(1, 0)[3], 0);
  EXPECT_EQ(image(2, 0)[3], 180);
  EXPECT_EQ(image(3, 0)[3], 30);
  const DdsFileBytes rising{0, 200, code_byte(0), code_byte(1), 0, 0, 0, 0};
  image = dds_image(with_more(with_more(dds_blocks("DXT5", 4, 4), rising), kRedBlue));
  EXPECT_EQ(image(2, 0)[3], 40);
  EXPECT_EQ(image(3, 0)[3], 255);
}

TEST(DdsFile, BlocksReachOverTheBorder) {
  DdsFileBytes bytes = dds_blocks("DXT1", 5, 6);
  for (int i = 0; i < 4; ++i) bytes = with_more(bytes, kRedBlue);
  const ImageRgba8 image = dds_image(bytes);
  EXPECT_EQ(image.width(), 5);
  EXPECT_EQ(image.height(), 6);
  EXPECT_EQ(image(4, 4), (Rgba8{255, 0, 0, 255}));
  bytes.pop_back();
  EXPECT_THAT(dds_error(bytes), HasSubstr("ends too early"));
}

TEST(DdsFile, PlainPixelsFollowTheirMasks) {
  EXPECT_EQ(dds_image(with_more(dds_plain(32, {0xFF0000, 0xFF00, 0xFF, 0xFF000000}),
                                {1, 2, 3, 4, 5, 6, 7, 8}))(1, 0),
            (Rgba8{7, 6, 5, 8}));
  EXPECT_EQ(
      dds_image(with_more(dds_plain(24, {0xFF, 0xFF00, 0xFF0000, 0}), {1, 2, 3, 4, 5, 6}))(1, 0),
      (Rgba8{4, 5, 6, 255}));
  EXPECT_EQ(dds_image(with_more(dds_plain(16, {0xF800, 0x7E0, 0x1F, 0}), {0, 0xF8, 0xE0, 7}))(1, 0),
            (Rgba8{0, 255, 0, 255}));
}

TEST(DdsFile, SecondHeadersAreRead) {
  DdsFileBytes bytes = dds_blocks("DX10", 4, 4);
  bytes.resize(148);
  put(bytes, 128, 71);
  EXPECT_EQ(dds_image(with_more(bytes, kRedBlue))(0, 0), (Rgba8{255, 0, 0, 255}));
  put(bytes, 128, 98);
  EXPECT_THAT(dds_error(with_more(bytes, kRedBlue)), HasSubstr("DXGI 98"));
}

TEST(DdsFile, MalformedFilesAreErrors) {
  const DdsFileBytes whole = with_more(dds_blocks("DXT1", 4, 4), kRedBlue);
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_THAT(dds_error({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)}),
                HasSubstr("a.dds"))
        << size;
  EXPECT_THAT(dds_error(dds_blocks("ATI2", 4, 4)), HasSubstr("ATI2"));
  EXPECT_THAT(dds_error(dds_blocks("DXT1", 0, 4)), HasSubstr("0 x 4"));
  EXPECT_THAT(dds_error(dds_blocks("DXT1", 60000, 60000)), HasSubstr("ends too early"));
  EXPECT_THAT(dds_error(dds_blocks("DX10", 4, 4)), HasSubstr("ends too early"));
  EXPECT_THAT(dds_error(dds_plain(7, {1, 2, 4, 0})), HasSubstr("7 bits"));
}

}  // namespace
}  // namespace saccade
