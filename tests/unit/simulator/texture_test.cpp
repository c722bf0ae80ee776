#include "simulator/scene/texture.h"

#include <gtest/gtest.h>

namespace saccade {
namespace {

/// 4 x 2 texels: 0 1 2 3 above 10 11 12 13.
ImageF ramp() {
  ImageF image(4, 2);
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 4; ++x) image(x, y) = static_cast<float>(10 * y + x);
  return image;
}

TEST(Texture, TexelCentresLieAtHalves) {
  const Texture texture(ramp());
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 4; ++x)
      EXPECT_DOUBLE_EQ(texture.at((x + 0.5) / 4, 1 - (y + 0.5) / 2), 10 * y + x);
}

TEST(Texture, InterpolatesLinearly) {
  const Texture texture(ramp());
  EXPECT_DOUBLE_EQ(texture.at_texel(1.25, 0.5), 6.25);
}

TEST(Texture, RepeatBlendsTheLastTexelWithTheFirst) {
  const Texture texture(ramp());
  EXPECT_DOUBLE_EQ(texture.at_texel(3.5, 0), 1.5);
  EXPECT_DOUBLE_EQ(texture.at_texel(-0.5, 0), 1.5);
  EXPECT_DOUBLE_EQ(texture.at_texel(4.25, 0), 0.25);
  EXPECT_DOUBLE_EQ(texture.at_texel(1, -0.25), 3.5);
  EXPECT_NEAR(texture.at_texel(-1e-18, 0), 0, 1e-12);
  EXPECT_DOUBLE_EQ(texture.at_texel(4e9 + 2, 2e9 + 1), 12);
}

TEST(Texture, ClampHoldsTheBorder) {
  const Texture texture(ramp(), Wrap::kClamp, Wrap::kClamp);
  EXPECT_DOUBLE_EQ(texture.at_texel(17, 0), 3);
  EXPECT_DOUBLE_EQ(texture.at_texel(-3, -3), 0);
  EXPECT_DOUBLE_EQ(texture.at_texel(3.5, 1.5), 13);
}

TEST(Texture, MirrorTurnsAroundAtTexelEdges) {
  const Texture texture(ramp(), Wrap::kMirror, Wrap::kMirror);
  EXPECT_DOUBLE_EQ(texture.at_texel(4, 0), 3);
  EXPECT_DOUBLE_EQ(texture.at_texel(5, 0), 2);
  EXPECT_DOUBLE_EQ(texture.at_texel(-1, 0), 0);
  EXPECT_DOUBLE_EQ(texture.at_texel(-2.5, 0), 1.5);
  EXPECT_DOUBLE_EQ(texture.at_texel(8, 0), 0);
}

TEST(Texture, ASingleTexelIsThatEverywhere) {
  const Texture texture(ImageF(1, 1, 0.25F));
  EXPECT_DOUBLE_EQ(texture.at(0.3, 0.7), 0.25);
  EXPECT_DOUBLE_EQ(texture.at(-7.1, 12.4), 0.25);
}

}  // namespace
}  // namespace saccade
