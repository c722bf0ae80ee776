#include "estimator/reconstruction/gradient/poisson.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

namespace saccade {
namespace {

ImageF bumps(int width, int height, bool is_zero_at_border) {
  ImageF image(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const double bump = std::sin(0.3 * x) + std::cos(0.17 * y + 0.05 * x);
      const double fade =
          std::sin(M_PI * (x + 1) / (width + 1)) * std::sin(M_PI * (y + 1) / (height + 1));
      image(x, y) = static_cast<float>(is_zero_at_border ? bump * fade : bump);
    }
  return image;
}

class Poisson : public ::testing::TestWithParam<std::pair<int, int>> {};

TEST_P(Poisson, TrueGradientsGiveTheImageWithNeumannBoundary) {
  const auto [width, height] = GetParam();
  ImageF image = bumps(width, height, false);
  const ImageF solved = solve_poisson(divergence(forward_gradient(image)), Boundary::kNeumann);
  subtract_mean(image);
  for (std::size_t i = 0; i < image.size(); ++i)
    ASSERT_NEAR(solved.pixels()[i], image.pixels()[i], 2e-4) << i;
}

TEST_P(Poisson, TrueGradientsGiveAnImageThatGoesAround) {
  const auto [width, height] = GetParam();
  ImageF image(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      image(x, y) = static_cast<float>(std::sin(2 * M_PI * 3 * x / width) +
                                       std::cos(0.17 * y + 2 * M_PI * x / width));
  GradientField gradient = forward_gradient(image);
  for (int y = 0; y < height; ++y) gradient.x(width - 1, y) = image(0, y) - image(width - 1, y);
  const ImageF solved = solve_poisson(divergence(gradient, true), Boundary::kWrapped);
  subtract_mean(image);
  for (std::size_t i = 0; i < image.size(); ++i)
    ASSERT_NEAR(solved.pixels()[i], image.pixels()[i], 2e-4) << i;
}

/// The image is 0 around the grid, so that the 5-point Laplacian is that of the padded image.
TEST_P(Poisson, DirichletSolvesTheLaplacianWithZeroAround) {
  const auto [width, height] = GetParam();
  const ImageF image = bumps(width, height, true);
  ImageF laplacian(width, height);
  const auto at = [&](int x, int y) {
    return x < 0 || y < 0 || x >= width || y >= height ? 0.0F : image(x, y);
  };
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      laplacian(x, y) = at(x - 1, y) + at(x + 1, y) + at(x, y - 1) + at(x, y + 1) - 4 * image(x, y);
  const ImageF solved = solve_poisson(laplacian, Boundary::kDirichlet);
  for (std::size_t i = 0; i < image.size(); ++i)
    ASSERT_NEAR(solved.pixels()[i], image.pixels()[i], 2e-4) << i;
}

/// Against the definition, as a library's transform may be scaled otherwise.
TEST_P(Poisson, CosineTransformIsOrthonormal) {
  const auto [width, height] = GetParam();
  ImageF wave(width, height);
  const int k = 2, l = 3;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      wave(x, y) = static_cast<float>(2 / std::sqrt(static_cast<double>(width * height)) *
                                      std::cos(M_PI * k * (x + 0.5) / width) *
                                      std::cos(M_PI * l * (y + 0.5) / height));
  ImageF coefficients = wave;
  cosine_transform(coefficients);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      ASSERT_NEAR(coefficients(x, y), x == k && y == l ? 1 : 0, 1e-5) << x << ' ' << y;
  inverse_cosine_transform(coefficients);
  for (std::size_t i = 0; i < wave.size(); ++i)
    ASSERT_NEAR(coefficients.pixels()[i], wave.pixels()[i], 1e-5);
}

INSTANTIATE_TEST_SUITE_P(Sizes, Poisson,
                         ::testing::Values(std::pair{48, 36}, std::pair{47, 36},
                                           std::pair{31, 33}));

}  // namespace
}  // namespace saccade
