#include "core/image.h"

#include <gtest/gtest.h>

#include <numeric>

#include "core/random.h"
#include "core/srgb.h"
#include "tests/support/jacobian_check.h"

namespace saccade {
namespace {

using Eigen::Vector2d;

Image<double> noise(int width, int height) {
  Image<double> image(width, height);
  for (std::size_t i = 0; i < image.size(); ++i) image.pixels()[i] = Random(3).uniform(0, i);
  return image;
}

TEST(Image, IsRowMajor) {
  Image<int> image(3, 2);
  image(2, 1) = 5;
  EXPECT_EQ(image.pixels()[5], 5);
  EXPECT_EQ(image.width(), 3);
  EXPECT_EQ(image.height(), 2);
}

TEST(Image, SampleReproducesPixelsAtTheirCentres) {
  const Image<double> image = noise(5, 4);
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 5; ++x)
      EXPECT_NEAR(sample(image, static_cast<double>(x), static_cast<double>(y)), image(x, y),
                  1e-15);
}

TEST(Image, SampleOfAPlaneIsExact) {
  Image<double> image(6, 5);
  for (int y = 0; y < 5; ++y)
    for (int x = 0; x < 6; ++x) image(x, y) = 2 * x - 3 * y + 1;
  const auto s = sample_with_gradient(image, 2.3, 1.75);
  EXPECT_NEAR(s.value, 2 * 2.3 - 3 * 1.75 + 1, 1e-14);
  EXPECT_NEAR(s.dx, 2, 1e-14);
  EXPECT_NEAR(s.dy, -3, 1e-14);
}

TEST(Image, GradientIsTheDerivativeOfTheInterpolant) {
  const Image<double> image = noise(9, 8);
  for (std::uint64_t i = 0; i < 50; ++i) {
    const Vector2d at(0.1 + 7.8 * Random(1).uniform(1, i), 0.1 + 6.8 * Random(1).uniform(2, i));
    // Within one cell: the interpolant has kinks on the grid lines.
    if ((at - at.array().round().matrix()).cwiseAbs().minCoeff() < 1e-3) continue;
    const auto s = sample_with_gradient(image, at.x(), at.y());
    const auto value = [&](const Vector2d& p) {
      return Eigen::Matrix<double, 1, 1>(sample(image, p.x(), p.y()));
    };
    testing::expect_jacobian(Eigen::Matrix<double, 1, 2>(s.dx, s.dy), value, at);
  }
}

TEST(Image, SplatWeightsSumToOneAndAreTheSamplesWeights) {
  for (const Vector2d& at :
       {Vector2d(1.3, 2.6), Vector2d(0, 0), Vector2d(4, 3), Vector2d(4, 1.5)}) {
    Image<double> drawn(5, 4);
    ASSERT_TRUE(is_inside(drawn, at.x(), at.y()));
    splat(drawn, at.x(), at.y(), 1.0);
    EXPECT_NEAR(std::accumulate(drawn.pixels().begin(), drawn.pixels().end(), 0.0), 1, 1e-15);
    const Image<double> image = noise(5, 4);
    const double dot = std::inner_product(drawn.pixels().begin(), drawn.pixels().end(),
                                          image.pixels().begin(), 0.0);
    EXPECT_NEAR(dot, sample(image, at.x(), at.y()), 1e-15);
  }
}

TEST(Image, InsideEndsAtTheOuterPixelCentres) {
  const ImageF image(5, 4);
  EXPECT_TRUE(is_inside(image, 4.0, 3.0));
  EXPECT_FALSE(is_inside(image, 4.001, 3.0));
  EXPECT_FALSE(is_inside(image, -0.001, 3.0));
}

TEST(Srgb, EveryCodeSurvivesTheRoundTrip) {
  for (int code = 0; code < 256; ++code) {
    const auto c = static_cast<std::uint8_t>(code);
    EXPECT_EQ(srgb8_from_linear(linear_from_srgb8(c)), c);
  }
}

TEST(Srgb, ToneCurveGoesThroughGainAndGamma) {
  ImageF linear(4, 1);
  linear(0, 0) = 0.25F;
  linear(1, 0) = 0.5F;
  linear(2, 0) = -1.0F;
  linear(3, 0) = std::nanf("");
  const auto codes = [&](const ToneCurve& curve) {
    const ImageU8 image = codes_from_linear(linear, curve);
    return std::vector<int>(image.pixels().begin(), image.pixels().end());
  };
  EXPECT_EQ(codes({}), (std::vector<int>{137, 188, 0, 0}));
  EXPECT_EQ(codes({.gain = 2, .gamma = {}}), (std::vector<int>{188, 255, 0, 0}));
  EXPECT_EQ(codes({.gain = 1, .gamma = 1}), (std::vector<int>{64, 128, 0, 0}));
  EXPECT_EQ(codes({.gain = 2, .gamma = 2}), (std::vector<int>{180, 255, 0, 0}));
}

TEST(Srgb, EveryCodeOfAToneCurveStandsForARadianceThatGivesItBack) {
  for (const ToneCurve& curve :
       {ToneCurve{}, ToneCurve{.gain = 0.2, .gamma = {}}, ToneCurve{.gain = 3, .gamma = 2.2},
        ToneCurve{.gain = 1, .gamma = 1}}) {
    const std::array<float, 256> radiance = linear_of_codes(curve);
    ImageF linear(256, 1);
    std::copy(radiance.begin(), radiance.end(), linear.pixels().begin());
    const ImageU8 codes = codes_from_linear(linear, curve);
    for (int code = 0; code < 256; ++code) EXPECT_EQ(codes(code, 0), code);
  }
  EXPECT_NEAR(linear_of_codes({.gain = 0.5, .gamma = {}})[255], 2, 1e-6);
}

TEST(Srgb, CurveHasItsKnownValues) {
  EXPECT_NEAR(linear_from_srgb(0.5), 0.21404114048, 1e-10);
  EXPECT_NEAR(linear_from_srgb(0.02), 0.02 / 12.92, 1e-15);
  EXPECT_EQ(linear_from_srgb(1), 1);
  for (double x = 0; x <= 1; x += 0.01) EXPECT_NEAR(srgb_from_linear(linear_from_srgb(x)), x, 1e-7);
  EXPECT_EQ(srgb8_from_linear(2.0F), 255);
  EXPECT_EQ(srgb8_from_linear(-1.0F), 0);
  EXPECT_EQ(srgb8_from_linear(std::nanf("")), 0);
}

}  // namespace
}  // namespace saccade
