#include "estimator/tracking/edges/gaussian_blur.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.h"

namespace saccade {
namespace {

PaddedImage random_image(int width, int height, int margin) {
  PaddedImage image(width, height, margin);
  const Random random(5);
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    image.pixels[i] = static_cast<float>(random.uniform(0, i));
  return image;
}

/// The two-dimensional sum, margins included.
double convolve(const PaddedImage& image, int x, int y, int size, double sigma) {
  const int radius = size / 2;
  double sum = 0;
  double weights = 0;
  for (int dy = -radius; dy <= radius; ++dy)
    for (int dx = -radius; dx <= radius; ++dx) {
      const double w = std::exp(-(dx * dx + dy * dy) / (2 * sigma * sigma));
      sum += w * static_cast<double>(image.row(y + dy)[x + dx]);
      weights += w;
    }
  return sum / weights;
}

struct Kernel {
  int size;
  double sigma;
};

class GaussianBlurOf : public ::testing::TestWithParam<Kernel> {};

TEST_P(GaussianBlurOf, IsTheDirectConvolution) {
  const auto [size, sigma] = GetParam();
  const PaddedImage in = random_image(33, 21, size / 2 + 1);
  PaddedImage out(in.width, in.height, in.margin);
  GaussianBlur(size, sigma).apply(in, out);
  for (int y = 0; y < in.height; ++y)
    for (int x = 0; x < in.width; ++x)
      ASSERT_NEAR(out.row(y)[x], convolve(in, x, y, size, sigma), 2e-6) << x << ' ' << y;
}

TEST_P(GaussianBlurOf, AnImpulseSumsToOneAndIsSymmetric) {
  const auto [size, sigma] = GetParam();
  constexpr int kCentre = 10;
  PaddedImage in(21, 21, size / 2);
  in.row(kCentre)[kCentre] = 1;
  PaddedImage out(21, 21, size / 2);
  GaussianBlur(size, sigma).apply(in, out);
  double sum = 0;
  for (const float value : out.pixels) sum += static_cast<double>(value);
  EXPECT_NEAR(sum, 1, 1e-6);
  for (int i = 0; i <= size / 2; ++i)
    for (int j = 0; j <= size / 2; ++j) {
      const float value = out.row(kCentre + i)[kCentre + j];
      EXPECT_EQ(value, out.row(kCentre - i)[kCentre + j]);
      EXPECT_EQ(value, out.row(kCentre + i)[kCentre - j]);
      EXPECT_FLOAT_EQ(value, out.row(kCentre + j)[kCentre + i]);
    }
}

INSTANTIATE_TEST_SUITE_P(Sizes, GaussianBlurOf,
                         ::testing::Values(Kernel{1, 1.0}, Kernel{3, 0.5}, Kernel{5, 1.1},
                                           Kernel{9, 2.0}, Kernel{15, 6.0}));

TEST(GaussianBlur, LeavesTheMarginsOfTheResult) {
  const PaddedImage in = random_image(9, 7, 3);
  PaddedImage out(9, 7, 3);
  std::fill(out.pixels.begin(), out.pixels.end(), -7.0F);
  GaussianBlur(5, 1.0).apply(in, out);
  EXPECT_EQ(out.row(-1)[4], -7.0F);
  EXPECT_EQ(out.row(7)[4], -7.0F);
  EXPECT_EQ(out.row(3)[-1], -7.0F);
  EXPECT_EQ(out.row(3)[9], -7.0F);
}

}  // namespace
}  // namespace saccade
