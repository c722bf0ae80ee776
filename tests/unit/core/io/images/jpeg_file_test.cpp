#include "core/io/images/jpeg_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include <jpeglib.h>

#include "tests/support/damage.h"
#include "tests/support/error_of.h"

namespace saccade {
namespace {

using testing::error_of;
using ::testing::HasSubstr;

std::span<const std::byte> jpeg_bytes(const std::string& file) {
  return std::as_bytes(std::span(file));
}

struct JpegKind {
  J_COLOR_SPACE space;
  int components;
  bool is_progressive = false;
};

/// `codes` of a row, repeated for all of them.
std::string jpeg_of(const JpegKind& kind, std::vector<std::uint8_t> codes, unsigned height) {
  jpeg_compress_struct state{};
  jpeg_error_mgr errors{};
  state.err = jpeg_std_error(&errors);
  jpeg_create_compress(&state);
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&state, &bytes, &size);
  state.image_width = static_cast<unsigned>(codes.size()) / static_cast<unsigned>(kind.components);
  state.image_height = height;
  state.input_components = kind.components;
  state.in_color_space = kind.space;
  jpeg_set_defaults(&state);
  jpeg_set_quality(&state, 100, TRUE);
  if (kind.is_progressive) jpeg_simple_progression(&state);
  jpeg_start_compress(&state, TRUE);
  JSAMPROW row = codes.data();
  for (unsigned y = 0; y < height; ++y) jpeg_write_scanlines(&state, &row, 1);
  jpeg_finish_compress(&state);
  jpeg_destroy_compress(&state);
  std::string file(reinterpret_cast<const char*>(bytes), size);
  std::free(bytes);
  return file;
}

/// Steps from dark to light, coarse enough that little is lost.
std::vector<std::uint8_t> jpeg_ramp(std::size_t count) {
  std::vector<std::uint8_t> codes(count);
  for (std::size_t i = 0; i < count; ++i) codes[i] = static_cast<std::uint8_t>(40 + 3 * i);
  return codes;
}

ImageU8 jpeg_grey(const std::string& file) { return decode_jpeg_grey(jpeg_bytes(file), "a.jpg"); }
ImageRgb8 jpeg_rgb(const std::string& file) { return decode_jpeg_rgb(jpeg_bytes(file), "a.jpg"); }

TEST(JpegFile, GreyBaselineAndProgressive) {
  const std::vector<std::uint8_t> codes = jpeg_ramp(37);
  for (const bool is_progressive : {false, true}) {
    const ImageU8 image = jpeg_grey(jpeg_of({JCS_GRAYSCALE, 1, is_progressive}, codes, 19));
    ASSERT_EQ(image.width(), 37);
    ASSERT_EQ(image.height(), 19);
    for (int x = 0; x < 37; ++x)
      EXPECT_NEAR(image(x, 11), codes[static_cast<std::size_t>(x)], 1) << x;
  }
  EXPECT_NEAR(jpeg_rgb(jpeg_of({JCS_GRAYSCALE, 1}, codes, 3))(5, 1)[2], codes[5], 1);
}

TEST(JpegFile, ColourAndItsLuminance) {
  std::vector<std::uint8_t> codes;
  for (int x = 0; x < 20; ++x) codes.insert(codes.end(), {200, 120, 30});
  const std::string file = jpeg_of({JCS_RGB, 3}, codes, 20);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(jpeg_rgb(file)(7, 13)[k], codes[k], 2);
  EXPECT_NEAR(jpeg_grey(file)(7, 13), 0.299 * 200 + 0.587 * 120 + 0.114 * 30, 1);
}

TEST(JpegFile, InksAreTakenForInverted) {
  std::vector<std::uint8_t> codes;
  for (int x = 0; x < 16; ++x) codes.insert(codes.end(), {255, 128, 0, 200});
  const std::string file = jpeg_of({JCS_CMYK, 4}, codes, 16);
  const Rgb8 colour = jpeg_rgb(file)(8, 8);
  EXPECT_NEAR(colour[0], 200, 2);
  EXPECT_NEAR(colour[1], 200 * 128 / 255, 2);
  EXPECT_NEAR(colour[2], 0, 2);
  EXPECT_NEAR(jpeg_grey(file)(8, 8), 0.299 * 200 + 0.587 * 100, 3);
}

TEST(JpegFile, DamageIsAnError) {
  for (const bool is_progressive : {false, true}) {
    const std::string file = jpeg_of({JCS_GRAYSCALE, 1, is_progressive}, jpeg_ramp(60), 24);
    // The last bytes of the only scan may hold nothing but padding.
    testing::expect_damage_is_reported(file, file.size() - (is_progressive ? 0 : 4), jpeg_grey);
    EXPECT_THAT(error_of([&] { return jpeg_grey(file.substr(0, file.size() - 20)); }),
                HasSubstr("a.jpg: is a damaged JPEG picture: it ends too early"));
  }
  EXPECT_THAT(error_of([&] { return jpeg_grey("\xFF\xD8\xFF\xE0 no picture"); }),
              HasSubstr("a.jpg: is no JPEG picture or is damaged"));
}

TEST(JpegFile, AMarkOfTheEndIsNotMissed) {
  const std::string file = jpeg_of({JCS_GRAYSCALE, 1}, jpeg_ramp(32), 16);
  EXPECT_EQ(jpeg_grey(file.substr(0, file.size() - 2)), jpeg_grey(file));
}

TEST(JpegFile, AHeaderAloneTakesNoMemory) {
  std::string file = jpeg_of({JCS_GRAYSCALE, 1}, jpeg_ramp(16), 16);
  const std::size_t frame = file.find("\xFF\xC0");
  ASSERT_NE(frame, std::string::npos);
  for (const std::size_t at : {frame + 5, frame + 7}) file.replace(at, 2, std::string("\xFF\0", 2));
  EXPECT_THAT(error_of([&] { return jpeg_grey(file); }), HasSubstr("is a picture of"));
}

}  // namespace
}  // namespace saccade
