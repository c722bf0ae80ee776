#include "eval/metrics/image_metrics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace saccade {
namespace {

ImageF pattern(int width, int height) {
  ImageF image(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      image(x, y) = static_cast<float>(std::sin(0.4 * x) + ((x / 5 + y / 4) % 2));
  return image;
}

ImageComparison affine(float scale, float offset) {
  ImageComparison c;
  c.truth = pattern(40, 30);
  c.estimate = c.truth;
  for (float& value : c.estimate.pixels()) value = scale * value + offset;
  c.mask = ImageU8(40, 30, 1);
  c.observed = 1;
  return c;
}

TEST(ImageMetrics, AnAffineChangeIsFittedAway) {
  const auto s = score_image(affine(2, -3));
  ASSERT_TRUE(s);
  EXPECT_NEAR(s->scale, 0.5, 1e-5);
  EXPECT_NEAR(s->offset, 1.5, 1e-5);
  EXPECT_NEAR(s->pearson, 1, 1e-6);
  EXPECT_NEAR(s->mse, 0, 1e-6);
  EXPECT_NEAR(s->ssim, 1, 1e-5);
  EXPECT_NEAR(s->gradient_pearson, 1, 1e-6);
}

TEST(ImageMetrics, TheNegativeIsNotTheImage) {
  const auto s = score_image(affine(-1, 0));
  ASSERT_TRUE(s);
  EXPECT_NEAR(s->pearson, -1, 1e-6);
  EXPECT_LT(s->scale, 0);  // the fit turns it around, and says so
}

/// One window over the whole of two constant halves has the closed form of its moments.
TEST(ImageMetrics, SimilarityOfConstantImagesIsTheLuminanceTerm) {
  ImageF a(30, 30, 1.0F), b(30, 30, 2.0F);
  a(0, 0) = 0;  // the range is 1
  const ImageU8 inner = [] {
    ImageU8 mask(30, 30, 1);
    return mask;
  }();
  const double expected = (2 * 1 * 2 + 1e-4) / (1 + 4 + 1e-4);
  EXPECT_NEAR(structural_similarity(a, b, inner), expected, 0.02);
}

TEST(ImageMetrics, WhatIsOffTheMaskDoesNotCount) {
  ImageComparison c = affine(1, 0);
  for (int x = 0; x < 10; ++x)
    for (int y = 0; y < 30; ++y) {
      c.estimate(x, y) = 100;
      c.mask(x, y) = 0;
    }
  const auto s = score_image(c);
  ASSERT_TRUE(s);
  EXPECT_NEAR(s->ssim, 1, 1e-5);
  EXPECT_NEAR(s->gradient_pearson, 1, 1e-5);
  c.mask.fill(0);
  EXPECT_FALSE(score_image(c));
}

TEST(ImageMetrics, AConstantEstimateExplainsNothing) {
  // 0.1 is no sum of powers of two: naive sums of squares would leave a variance, and so a scale.
  ImageComparison c = affine(1, 0);
  c.estimate.fill(0.1F);
  const auto s = score_image(c);
  ASSERT_TRUE(s);
  EXPECT_EQ(s->scale, 0);
  EXPECT_EQ(s->pearson, 0);
  EXPECT_EQ(s->gradient_pearson, 0);
  double mean = 0;
  for (const float value : c.truth.pixels())
    mean += static_cast<double>(value) / static_cast<double>(c.truth.size());
  EXPECT_NEAR(s->offset, mean, 1e-12);
}

TEST(ImageMetrics, AConstantTruthOrTooFewPixelsHaveNoScore) {
  ImageComparison c = affine(1, 0);
  c.truth.fill(0.1F);
  EXPECT_FALSE(score_image(c));
  c = affine(1, 0);
  std::fill(c.mask.pixels().begin() + 99, c.mask.pixels().end(), std::uint8_t{0});
  EXPECT_FALSE(score_image(c));
  c.mask.pixels()[99] = 1;
  EXPECT_TRUE(score_image(c));
}

TEST(ImageMetrics, NothingToScoreIsNull) {
  Metrics metrics;
  set_image_scores(metrics, std::vector<std::optional<ImageScores>>{std::nullopt});
  EXPECT_FALSE(metrics.get("reconstruction.ssim"));
  EXPECT_EQ(metrics.get("reconstruction.views"), 1);
}

}  // namespace
}  // namespace saccade
