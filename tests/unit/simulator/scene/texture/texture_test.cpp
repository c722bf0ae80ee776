#include "simulator/scene/texture/texture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/random.h"

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

ImageF noise_picture(int width, int height) {
  const Random random(5);
  ImageF image(width, height);
  for (std::size_t i = 0; i < image.size(); ++i)
    image.pixels()[i] = static_cast<float>(random.uniform(0, i));
  return image;
}

TEST(Texture, RangeBoundsTheInterpolant) {
  const Random random(6);
  for (const Wrap wrap : {Wrap::kRepeat, Wrap::kClamp, Wrap::kMirror}) {
    const Texture texture(noise_picture(37, 22), wrap, wrap);
    for (std::uint64_t k = 0; k < 300; ++k) {
      const double size = std::pow(60.0, random.uniform(1, k));
      const double x = 120 * random.uniform(2, k) - 40;
      const double y = 80 * random.uniform(3, k) - 30;
      const TexelBox box{x, x + size * random.uniform(4, k), y, y + size * random.uniform(5, k)};
      const TexelRange range = texture.range(box);
      for (std::uint64_t i = 0; i < 30; ++i) {
        const double value =
            texture.at_texel(box.x0 + (box.x1 - box.x0) * random.uniform(6, 100 * k + i),
                             box.y0 + (box.y1 - box.y0) * random.uniform(7, 100 * k + i));
        ASSERT_GE(value, range.low - 1e-6);
        ASSERT_LE(value, range.high + 1e-6);
      }
    }
  }
}

TEST(Texture, RangeOfASmallBoxIsThatOfItsTexels) {
  const Texture texture(noise_picture(37, 22));
  const std::array<float, 4> cell = texture.cell(11, 7);
  const TexelRange range = texture.range({11.2, 11.4, 7.3, 7.9});
  EXPECT_EQ(range.low, *std::min_element(cell.begin(), cell.end()));
  EXPECT_EQ(range.high, *std::max_element(cell.begin(), cell.end()));
}

TEST(Texture, CellHoldsTheFourTexelsOfTheInterpolant) {
  for (const Wrap wrap : {Wrap::kRepeat, Wrap::kClamp, Wrap::kMirror}) {
    const Texture texture(noise_picture(7, 5), wrap, wrap);
    for (std::int64_t j = -11; j < 12; ++j)
      for (std::int64_t i = -15; i < 16; ++i) {
        const std::array<float, 4> cell = texture.cell(i, j);
        for (std::int64_t k = 0; k < 4; ++k)
          EXPECT_NEAR(
              cell[static_cast<std::size_t>(k)],
              texture.at_texel(static_cast<double>(i + k % 2), static_cast<double>(j + k / 2)),
              1e-6);
      }
  }
}

TEST(TexturePyramid, LevelZeroIsTheTextureAndTheTopItsMean) {
  for (const Wrap wrap : {Wrap::kRepeat, Wrap::kClamp, Wrap::kMirror})
    for (const auto& [width, height] : {std::pair(37, 22), {64, 16}, {1, 5}, {3, 3}}) {
      const ImageF picture = noise_picture(width, height);
      const Texture texture(picture, wrap, wrap);
      double mean = 0;
      for (const float value : picture.pixels()) mean += static_cast<double>(value);
      mean /= static_cast<double>(picture.size());
      for (int k = 0; k < 20; ++k) {
        const double x = -50 + 7.3 * k;
        const double y = 40 - 5.1 * k;
        EXPECT_EQ(texture.at_texel(x, y, 0), texture.at_texel(x, y));
        EXPECT_EQ(texture.at_texel(x, y, -3), texture.at_texel(x, y));
        EXPECT_NEAR(texture.at_texel(x, y, 20), mean, 1e-5) << width << " x " << height;
      }
    }
}

TEST(TexturePyramid, AContinuousSignalStaysOne) {
  const Texture texture(noise_picture(37, 22), Wrap::kRepeat, Wrap::kMirror);
  const Random random(5);
  for (std::uint64_t k = 0; k < 2000; ++k) {
    const auto draw = [&](std::uint64_t stream) { return random.uniform(stream, k); };
    const double x = 200 * draw(0) - 100;
    const double y = 200 * draw(1) - 100;
    // Half of them just at a level of the pyramid.
    const double level = k % 2 == 0 ? 6 * draw(2) : std::floor(6 * draw(2));
    const double here = texture.at_texel(x, y, level);
    EXPECT_NEAR(texture.at_texel(x + 1e-6, y, level), here, 1e-5);
    EXPECT_NEAR(texture.at_texel(x, y - 1e-6, level), here, 1e-5);
    EXPECT_NEAR(texture.at_texel(x, y, level + 1e-6), here, 1e-5);
    EXPECT_NEAR(texture.at_texel(x, y, level - 1e-6), here, 1e-5);
    EXPECT_NEAR(texture.at_texel(x + 37, y + 44, level), here, 1e-5) << "a period";
    EXPECT_NEAR(texture.at_texel(x, -1 - y, level), here, 1e-5) << "the mirror";
  }
}

TEST(TexturePyramid, LevelOfAPowerOfTwoIsTheMeanOfItsTexels) {
  const ImageF picture = noise_picture(16, 8);
  const Texture texture(picture);
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < 4; ++i) {
      double mean = 0;
      for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 4; ++x) mean += static_cast<double>(picture(4 * i + x, 4 * j + y)) / 16;
      EXPECT_NEAR(texture.at_texel(4 * i + 1.5, 4 * j + 1.5, 2), mean, 1e-6);
    }
}

TEST(TexturePyramid, RangeHoldsForItsLevels) {
  const Texture texture(noise_picture(37, 22), Wrap::kRepeat, Wrap::kClamp);
  const Random random(9);
  for (std::uint64_t k = 0; k < 300; ++k) {
    const auto draw = [&](std::uint64_t stream) { return random.uniform(stream, k); };
    const double x = 100 * draw(0) - 50;
    const double y = 60 * draw(1) - 30;
    const TexelBox box{x, x + 9 * draw(2), y, y + 9 * draw(3)};
    const double low = 6 * draw(4) - 1;
    const double high = low + draw(5);
    const TexelRange range = texture.range(box, low, high);
    for (std::uint64_t i = 0; i < 20; ++i) {
      const auto part = [&](std::uint64_t stream) { return random.uniform(stream, 20 * k + i); };
      const double value =
          texture.at_texel(box.x0 + (box.x1 - box.x0) * part(6),
                           box.y0 + (box.y1 - box.y0) * part(7), low + (high - low) * part(8));
      ASSERT_GE(value, range.low - 1e-6);
      ASSERT_LE(value, range.high + 1e-6);
    }
  }
}

}  // namespace
}  // namespace saccade
