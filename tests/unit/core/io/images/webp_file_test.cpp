#include "core/io/images/webp_file.h"

#include <gtest/gtest.h>

#include "core/io/images/image_file.h"

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

}  // namespace
}  // namespace saccade
