#include "core/io/images/hdr_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/damage.h"
#include "tests/support/error_of.h"

namespace saccade {
namespace {

using testing::error_of;
using ::testing::HasSubstr;

ImageRgbF hdr_rgb(const std::string& file) {
  return decode_hdr(std::as_bytes(std::span(file)), "a.hdr");
}

const std::string kHdrHeader = "#?RADIANCE\n# a comment\nFORMAT=32-bit_rle_rgbe\nEXPOSURE=2\n\n";

TEST(HdrFile, ValuesAreMantissasTimesAPowerOfTwo) {
  const ImageRgbF image =
      hdr_rgb(kHdrHeader + "-Y 2 +X 1\n" + std::string("\x80\x40\x01\x81\x09\x09\x09\0", 8));
  EXPECT_EQ(image(0, 0), (RgbF{1, 0.5F, 1.0F / 128}));
  EXPECT_EQ(image(0, 1), (RgbF{0, 0, 0}));
}

/// A row of ten: nine alike and one other per component, the exponents one by one.
std::string encoded_hdr_row() {
  std::string row("\2\2\0\x0A", 4);
  for (const char c : {'\x80', '\x40', '\x20'}) row += std::string("\x89") + c + "\1" + c;
  return row + "\x0A" + std::string(10, '\x81');
}

TEST(HdrFile, RowsAreRunLengthEncoded) {
  const ImageRgbF image =
      hdr_rgb(kHdrHeader + "-Y 2 +X 10\n" + encoded_hdr_row() + encoded_hdr_row());
  for (int x = 0; x < 10; ++x) EXPECT_EQ(image(x, 1), (RgbF{1, 0.5F, 0.25F})) << x;
}

TEST(HdrFile, DamageIsAnError) {
  const std::string file = kHdrHeader + "-Y 2 +X 10\n" + encoded_hdr_row() + encoded_hdr_row();
  testing::expect_damage_is_reported(file, file.size(), hdr_rgb);
  EXPECT_THAT(
      error_of([] { return hdr_rgb(kHdrHeader + "-Y 2 -X 2\n"); }),
      HasSubstr("a.hdr: is no Radiance picture that can be decoded: it has the size '-Y 2"));
  EXPECT_THAT(error_of([] { return hdr_rgb("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n"); }),
              HasSubstr("format 32-bit_rle_xyze"));
  EXPECT_THAT(error_of([] { return hdr_rgb(kHdrHeader + "-Y 20000 +X 20000\n"); }),
              HasSubstr("ends too early"));
  EXPECT_THAT(error_of([] { return hdr_rgb(kHdrHeader + "-Y 900000 +X 900000\n"); }),
              HasSubstr("pixels; at most"));
}

}  // namespace
}  // namespace saccade
