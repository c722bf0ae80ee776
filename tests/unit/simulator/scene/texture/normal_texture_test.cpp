#include "simulator/scene/texture/normal_texture.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/io/images/image_file.h"

namespace saccade {
namespace {

Bytes png(const ImageRgb8& image) {
  const std::string bytes = encode_png(image);
  return {bytes.begin(), bytes.end()};
}

TEST(NormalTexture, DecodesCodesAsTheirVectors) {
  ImageRgb8 image(2, 1);
  image(0, 0) = {255, 0, 255};
  image(1, 0) = {128, 64, 200};
  const NormalTexture map = decode_normal_map(png(image), "a.png", {}, 0.5F);
  EXPECT_LT((map.at_texel(0, 0, 0) - Eigen::Vector3d(0.5, -0.5, 1)).norm(), 1e-6);
  EXPECT_LT(
      (map.at_texel(1, 0, 0) - Eigen::Vector3d(0.5 * (2 * 128 / 255.0 - 1),
                                               0.5 * (2 * 64 / 255.0 - 1), 2 * 200 / 255.0 - 1))
          .norm(),
      1e-6);
  EXPECT_LT(
      (map.at_texel(0.5, 0, 0) - 0.5 * (map.at_texel(0, 0, 0) + map.at_texel(1, 0, 0))).norm(),
      1e-6);
}

TEST(NormalTexture, NamesAPictureThatIsNone) {
  try {
    static_cast<void>(decode_normal_map({1, 2, 3}, "bumps.png", {}));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("bumps.png"), std::string::npos);
  }
}

}  // namespace
}  // namespace saccade
