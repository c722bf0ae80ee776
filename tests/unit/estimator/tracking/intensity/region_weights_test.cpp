#include "estimator/tracking/intensity/region_weights.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <set>

#include <Eigen/Core>

namespace saccade {
namespace {

constexpr int kWidth = 240, kHeight = 180;
constexpr int kResiduals = 50;

/// Adds residuals all over the image, `bad` ones in the region of one pixel, and learns from them.
void learn(RegionWeights& regions, const Eigen::Vector2f& where, float usual, float bad) {
  const std::size_t bad_region = regions.region_of(where);
  for (float y = 8; y < kHeight; y += 16)
    for (float x = 8; x < kWidth; x += 16) {
      const std::size_t region = regions.region_of({x, y});
      for (int i = 0; i < kResiduals; ++i)
        regions.add(region, region == bad_region ? bad : usual, 1);
    }
  regions.learn();
}

TEST(RegionWeights, AllWeighOneBeforeAnythingIsKnown) {
  RegionWeights regions(kWidth, kHeight);
  EXPECT_EQ(regions.weight(regions.region_of({100, 100})), 1);
  regions.learn();
  EXPECT_EQ(regions.weight(regions.region_of({100, 100})), 1);
}

TEST(RegionWeights, WhereResidualsAreLargerTheyCountLess) {
  RegionWeights regions(kWidth, kHeight);
  learn(regions, {100, 100}, 0.2F, 2);
  // Twice the usual residual, and a hundredth, over what it has here.
  EXPECT_NEAR(regions.weight(regions.region_of({100, 100})), 2 * 0.21F / 2, 1e-4);
  EXPECT_EQ(regions.weight(regions.region_of({20, 100})), 1);
}

TEST(RegionWeights, ThoseThatAreLargeEverywhereAreUsual) {
  RegionWeights regions(kWidth, kHeight);
  learn(regions, {100, 100}, 2, 2.5F);
  EXPECT_EQ(regions.weight(regions.region_of({100, 100})), 1);
}

TEST(RegionWeights, TwiceTheUsualIsNothingUnusual) {
  RegionWeights regions(kWidth, kHeight);
  learn(regions, {100, 100}, 0.2F, 0.4F);
  EXPECT_EQ(regions.weight(regions.region_of({100, 100})), 1);
  regions.reset();
  learn(regions, {100, 100}, 0.2F, 0.5F);
  EXPECT_NEAR(regions.weight(regions.region_of({100, 100})), 2 * 0.21F / 0.5F, 1e-4);
}

TEST(RegionWeights, MoreThanHalfOfTheImageMayShowSomethingElse) {
  RegionWeights regions(kWidth, kHeight);
  for (float y = 8; y < kHeight; y += 16)
    for (float x = 8; x < kWidth; x += 16)
      for (int i = 0; i < kResiduals; ++i)
        regions.add(regions.region_of({x, y}), y < 80 ? 0.2F : 3, 1);
  regions.learn();
  EXPECT_EQ(regions.weight(regions.region_of({100, 20})), 1);
  EXPECT_LT(regions.weight(regions.region_of({100, 120})), 0.2);
}

TEST(RegionWeights, OfFewRegionsNobodyKnowsWhatIsUsual) {
  RegionWeights regions(64, 16);
  for (int i = 0; i < 100; ++i) {
    regions.add(0, 4, 1);
    for (std::size_t region = 1; region < 4; ++region) regions.add(region, 0.1F, 1);
  }
  regions.learn();
  EXPECT_EQ(regions.weight(0), 1);
}

TEST(RegionWeights, OfAWiderImageAreAsManyDegreesWide) {
  const RegionWeights regions(480, 360);
  EXPECT_EQ(regions.region_of({0, 0}), regions.region_of({31, 31}));
  EXPECT_NE(regions.region_of({31, 31}), regions.region_of({32, 31}));
}

TEST(RegionWeights, ASingleOutlierSaysLittle) {
  RegionWeights regions(kWidth, kHeight);
  learn(regions, {100, 100}, 0.2F, 0.2F);
  regions.add(regions.region_of({100, 100}), 1e6F, 1);
  regions.learn();
  EXPECT_EQ(regions.weight(regions.region_of({100, 100})), 1);
}

TEST(RegionWeights, WhatIsOverIsForgotten) {
  RegionWeights regions(kWidth, kHeight);
  learn(regions, {100, 100}, 0.2F, 2);
  for (int i = 0; i < 10; ++i) learn(regions, {100, 100}, 0.2F, 0.2F);
  EXPECT_EQ(regions.weight(regions.region_of({100, 100})), 1);
  learn(regions, {20, 20}, 0.2F, 2);
  regions.reset();
  EXPECT_EQ(regions.weight(regions.region_of({20, 20})), 1);
}

TEST(RegionWeights, RegionsAreSquaresThatCoverTheImageAndNeighboursOutsideBelongToThem) {
  const RegionWeights regions(kWidth, kHeight);
  std::set<std::size_t> all;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      all.insert(regions.region_of({static_cast<float>(x), static_cast<float>(y)}));
  EXPECT_EQ(all.size(), 15U * 12U);
  EXPECT_EQ(regions.region_of({-7, -1e6F}), regions.region_of({0, 0}));
  EXPECT_EQ(regions.region_of({1e6F, 300}), regions.region_of({kWidth - 1, kHeight - 1}));
  EXPECT_EQ(regions.region_of({0, 0}), regions.region_of({15, 15}));
  EXPECT_NE(regions.region_of({15, 15}), regions.region_of({16, 15}));
}

}  // namespace
}  // namespace saccade
