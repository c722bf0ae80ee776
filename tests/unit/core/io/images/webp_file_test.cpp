#include "core/io/images/webp_file.h"

#include <gtest/gtest.h>
#include <webp/encode.h>

#include <span>

#include "core/error.h"
#include "core/io/images/image_file.h"
#include "tests/support/damage.h"

namespace saccade {
namespace {

TEST(WebpFile, KeepsEveryPixel) {
  ImageRgb8 image(37, 21);
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x)
      image(x, y) = {static_cast<std::uint8_t>(7 * x), static_cast<std::uint8_t>(12 * y),
                     static_cast<std::uint8_t>(x * y)};
  const std::string bytes = encode_webp(image);
  const ImageRgba8 again = decode_image_rgba(std::as_bytes(std::span(bytes)), "memory");
  ASSERT_EQ(again.width(), image.width());
  ASSERT_EQ(again.height(), image.height());
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x)
      for (std::size_t k = 0; k < 3; ++k)
        ASSERT_EQ(again(x, y)[k], image(x, y)[k]) << x << " " << y;
}

ImageRgba8 webp_rgba(const std::string& file) {
  return decode_webp(std::as_bytes(std::span(file)), "a.webp");
}

TEST(WebpFile, AlphaAndLossyPictures) {
  const ImageRgba8 image(16, 16, Rgba8{100, 150, 200, 77});
  for (const bool is_lossy : {false, true}) {
    std::uint8_t* bytes = nullptr;
    const std::size_t size = is_lossy
                                 ? WebPEncodeRGBA(image.data()->data(), 16, 16, 64, 90, &bytes)
                                 : WebPEncodeLosslessRGBA(image.data()->data(), 16, 16, 64, &bytes);
    const ImageRgba8 again = webp_rgba({reinterpret_cast<const char*>(bytes), size});
    WebPFree(bytes);
    ASSERT_EQ(again.width(), 16);
    for (std::size_t k = 0; k < 4; ++k)
      EXPECT_NEAR(again(3, 5)[k], image(3, 5)[k], is_lossy ? 4 : 0) << k;
  }
}

TEST(WebpFile, DamageIsAnError) {
  const std::string file = encode_webp(ImageRgb8(9, 7, Rgb8{1, 2, 3}));
  testing::expect_damage_is_reported(file, file.size() - 2, webp_rgba);
}

TEST(WebpFile, AHandfulOfBytesIsNoLargePicture) {
  // Lossless, 16384 x 10240 pixels: as found by a fuzzer.
  constexpr unsigned char kBytes[] = {
      0x52, 0x49, 0x46, 0x46, 0x30, 0x00, 0x00, 0x00, 0x57, 0x45, 0x42, 0x50, 0x56, 0x50, 0x38,
      0x4c, 0x23, 0x00, 0x00, 0x00, 0x2f, 0xff, 0xff, 0xff, 0x09, 0x99, 0x8c, 0xe8, 0x7f, 0x57,
      0x45, 0x42, 0x50, 0xff, 0x80, 0x82, 0xb6, 0x6d, 0x98, 0x1e, 0x18, 0xe5, 0x0f, 0x75, 0x17,
      0xc1, 0x04, 0x0c, 0x72, 0x4c, 0x00, 0x74, 0x65, 0xf2, 0x7a, 0x01, 0x00};
  EXPECT_THROW(static_cast<void>(decode_webp(std::as_bytes(std::span(kBytes)), "a.webp")),
               InputError);
}

}  // namespace
}  // namespace saccade
