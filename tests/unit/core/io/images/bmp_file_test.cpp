#include "core/io/images/bmp_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/damage.h"
#include "tests/support/error_of.h"

namespace saccade {
namespace {

using testing::error_of;
using ::testing::HasSubstr;

std::string bmp_number(std::uint64_t value, int bytes) {
  std::string text;
  for (int i = 0; i < bytes; ++i, value >>= 8U) text += static_cast<char>(value);
  return text;
}

struct Bmp {
  std::int32_t width = 0, height = 0;
  std::uint32_t bits = 0, compression = 0;
  std::string masks{}, palette{}, pixels{};

  [[nodiscard]] std::string file() const {
    const auto header = static_cast<std::uint32_t>(40 + (masks.size() > 12 ? masks.size() : 0));
    const auto start = static_cast<std::uint32_t>(54 + masks.size() + palette.size());
    return "BM" + bmp_number(0, 8) + bmp_number(start, 4) + bmp_number(header, 4) +
           bmp_number(static_cast<std::uint32_t>(width), 4) +
           bmp_number(static_cast<std::uint32_t>(height), 4) + bmp_number(1, 2) +
           bmp_number(bits, 2) + bmp_number(compression, 4) + bmp_number(0, 12) +
           bmp_number(static_cast<std::uint32_t>(palette.size() / 4), 4) + bmp_number(0, 4) +
           masks + palette + pixels;
  }
};

ImageRgba8 bmp_rgba(const std::string& file) {
  return decode_bmp(std::as_bytes(std::span(file)), "a.bmp");
}

const std::string kTwoColours("\x1E\x14\x0A\0\x32\x64\xC8\0", 8);  // 10 20 30 and 200 100 50
constexpr Rgba8 kFirstColour{10, 20, 30, 255}, kSecondColour{200, 100, 50, 255};

TEST(BmpFile, RowsOfColourAreUpsideDown) {
  Bmp bmp{2, 2, 24};
  bmp.pixels = std::string("\1\2\3\4\5\6\0\0\7\x8\x9\xA\xB\xC\0\0", 16);
  EXPECT_EQ(bmp_rgba(bmp.file())(0, 0), (Rgba8{9, 8, 7, 255}));
  EXPECT_EQ(bmp_rgba(bmp.file())(1, 1), (Rgba8{6, 5, 4, 255}));
  bmp.height = -2;
  EXPECT_EQ(bmp_rgba(bmp.file())(0, 0), (Rgba8{3, 2, 1, 255}));
}

TEST(BmpFile, Palettes) {
  for (const std::uint32_t bits : {1U, 4U, 8U}) {
    Bmp bmp{2, 1, bits};
    bmp.palette = kTwoColours;
    bmp.pixels = bits == 8 ? std::string("\0\1\0\0", 4)
                           : std::string(1, bits == 1 ? '\x40' : '\x01') + std::string(3, '\0');
    const ImageRgba8 image = bmp_rgba(bmp.file());
    EXPECT_EQ(image(0, 0), kFirstColour) << bits;
    EXPECT_EQ(image(1, 0), kSecondColour) << bits;
  }
}

TEST(BmpFile, HeaderOfOs2) {
  const std::string file = "BM" + bmp_number(0, 8) + bmp_number(32, 4) + bmp_number(12, 4) +
                           bmp_number(1, 2) + bmp_number(1, 2) + bmp_number(1, 2) +
                           bmp_number(1, 2) + "\1\2\3\4\5\6" + std::string("\x80\0\0\0", 4);
  EXPECT_EQ(bmp_rgba(file)(0, 0), (Rgba8{6, 5, 4, 255}));
}

TEST(BmpFile, SixteenBits) {
  Bmp bmp{2, 1, 16};
  bmp.pixels = bmp_number(31U << 10U | 1U, 2) + bmp_number(16U << 5U, 2);
  EXPECT_EQ(bmp_rgba(bmp.file())(0, 0), (Rgba8{248, 0, 8, 255}));
  EXPECT_EQ(bmp_rgba(bmp.file())(1, 0), (Rgba8{0, 128, 0, 255}));
  bmp.compression = 3;
  bmp.masks = bmp_number(0xF800, 4) + bmp_number(0x7E0, 4) + bmp_number(0x1F, 4);
  bmp.pixels = bmp_number(1U << 11U | 63U << 5U, 2) + bmp_number(31, 2);
  EXPECT_EQ(bmp_rgba(bmp.file())(0, 0), (Rgba8{8, 252, 0, 255}));
}

TEST(BmpFile, AlphaWhereAMaskStatesIt) {
  Bmp bmp{1, 1, 32};
  bmp.pixels = "\1\2\3\4";
  EXPECT_EQ(bmp_rgba(bmp.file())(0, 0), (Rgba8{3, 2, 1, 255}));
  bmp.compression = 3;
  bmp.masks = bmp_number(0xFF, 4) + bmp_number(0xFF00, 4) + bmp_number(0xFF0000, 4) +
              bmp_number(0xFF000000U, 4);
  EXPECT_EQ(bmp_rgba(bmp.file())(0, 0), (Rgba8{1, 2, 3, 4}));
}

TEST(BmpFile, RunLengths) {
  Bmp bmp{4, 2, 8, 1};
  bmp.palette = kTwoColours;
  // three of colour 1; the next row, jump by one, one as it is, end
  bmp.pixels = std::string("\3\1\0\0\0\2\1\0\0\3\1\0\1\0\0\1", 16);
  const ImageRgba8 image = bmp_rgba(bmp.file());
  EXPECT_EQ(image(2, 1), kSecondColour);
  EXPECT_EQ(image(3, 1), kFirstColour);
  EXPECT_EQ(image(0, 0), kFirstColour);
  EXPECT_EQ(image(1, 0), kSecondColour);
  EXPECT_EQ(image(2, 0), kFirstColour);
  EXPECT_EQ(image(3, 0), kSecondColour);
  bmp.bits = 4;
  bmp.compression = 2;
  bmp.pixels = std::string("\3\x10\0\0\0\4\x01\x10\0\1", 10);
  const ImageRgba8 half = bmp_rgba(bmp.file());
  EXPECT_EQ(half(0, 1), kSecondColour);
  EXPECT_EQ(half(1, 1), kFirstColour);
  EXPECT_EQ(half(2, 1), kSecondColour);
  EXPECT_EQ(half(1, 0), kSecondColour);
  EXPECT_EQ(half(3, 0), kFirstColour);
}

TEST(BmpFile, DamageIsAnError) {
  Bmp runs{4, 2, 8, 1};
  runs.palette = kTwoColours;
  runs.pixels = std::string("\4\1\0\0\4\0\0\1", 8);
  testing::expect_damage_is_reported(runs.file(), runs.file().size(), bmp_rgba);
  Bmp plain{3, 2, 24};
  plain.pixels = std::string(24, '\x7F');
  testing::expect_damage_is_reported(plain.file(), plain.file().size(), bmp_rgba);
  runs.pixels = std::string("\0\2\5\0\0\1", 6);
  EXPECT_THAT(error_of([&] { return bmp_rgba(runs.file()); }),
              HasSubstr("has a jump beyond its border"));
  runs.pixels = std::string("\5\1\0\1", 4);
  EXPECT_THAT(error_of([&] { return bmp_rgba(runs.file()); }),
              HasSubstr("a.bmp: is no BMP picture that can be decoded: it has a run beyond"));
  plain.width = 1 << 19;
  EXPECT_THAT(error_of([&] { return bmp_rgba(plain.file()); }), HasSubstr("ends too early"));
  plain.height = 1 << 19;
  EXPECT_THAT(error_of([&] { return bmp_rgba(plain.file()); }), HasSubstr("pixels; at most"));
  plain.bits = 7;
  EXPECT_THAT(error_of([&] { return bmp_rgba(plain.file()); }), HasSubstr("7 bits per pixel"));
}

}  // namespace
}  // namespace saccade
