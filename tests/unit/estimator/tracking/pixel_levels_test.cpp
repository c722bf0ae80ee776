#include "estimator/tracking/pixel_levels.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace saccade {
namespace {

constexpr float kOn = 0.2F;
constexpr float kOff = 0.3F;
constexpr std::size_t kPixel = 5;

PixelLevels some_levels(double correction = 0.1) { return {4, 3, 0.2, 0.3, correction}; }

TEST(PixelLevels, PixelsAreCountedRowByRow) {
  EXPECT_EQ(some_levels().index({0, 3, 2, 1}), 11U);
  EXPECT_EQ(some_levels().index({0, 1, 1, 1}), kPixel);
}

TEST(PixelLevels, EventsStepByTheThresholdOfTheirPolarity) {
  PixelLevels levels = some_levels();
  levels.set(kPixel, -1, 3);
  EXPECT_FLOAT_EQ(levels.step(kPixel, 1), -1 + kOn);
  EXPECT_FLOAT_EQ(levels.step(kPixel, 1), -1 + 2 * kOn);
  EXPECT_FLOAT_EQ(levels.step(kPixel, -1), -1 + 2 * kOn - kOff);
  EXPECT_FLOAT_EQ(levels.step(kPixel + 1, -1), -kOff) << "the neighbour has its own";
}

TEST(PixelLevels, BetweenEventsAPixelIsHalfwayToTheNextOfItsKind) {
  PixelLevels levels = some_levels();
  levels.set(kPixel, -1, 3);
  EXPECT_EQ(levels.between(kPixel), -1) << "before the first event nothing says where it goes";
  levels.step(kPixel, 1);
  EXPECT_FLOAT_EQ(levels.between(kPixel), levels.level(kPixel) + kOn / 2);
  levels.step(kPixel, -1);
  EXPECT_FLOAT_EQ(levels.between(kPixel), levels.level(kPixel) - kOff / 2);
}

TEST(PixelLevels, TrustGrowsFromNothingTowardsOne) {
  PixelLevels levels = some_levels();
  EXPECT_EQ(levels.trust(kPixel), 0);
  levels.set(kPixel, 0, 10);
  EXPECT_FLOAT_EQ(levels.trust(kPixel), 10.0F / 11);
  levels.correct(kPixel, 0);
  EXPECT_FLOAT_EQ(levels.trust(kPixel), 11.0F / 12);
}

TEST(PixelLevels, ForgettingMakesAllOfThemUnknown) {
  PixelLevels levels = some_levels();
  for (std::size_t i = 0; i < 12; ++i) levels.set(i, 2, 4);
  levels.forget();
  for (std::size_t i = 0; i < 12; ++i) {
    EXPECT_EQ(levels.trust(i), 0);
    EXPECT_NEAR(levels.level(i), 0, 1e-6);
  }
}

TEST(PixelLevels, TheFirstLookSetsAnUnknownLevelEntirely) {
  PixelLevels levels = some_levels();
  levels.correct(kPixel, -1.25F);  // the map is brighter by so much
  EXPECT_FLOAT_EQ(levels.level(kPixel), 1.25F);
}

TEST(PixelLevels, CorrectionsAreAMeanThatTurnsIntoAConstantShare) {
  constexpr double kShare = 0.15;
  PixelLevels levels = some_levels(kShare);
  levels.set(kPixel, 0, 0);
  for (int look = 0; look < 20; ++look) {
    const float before = levels.level(kPixel);
    levels.correct(kPixel, 1);
    levels.settle(kPixel);
    const float share = std::max(static_cast<float>(kShare), 1.0F / static_cast<float>(look + 1));
    EXPECT_NEAR(before - levels.level(kPixel), share, 1e-5) << "look " << look;
  }
}

TEST(PixelLevels, WithoutALeastShareALevelIsTheMeanOfWhatTheMapShowed) {
  PixelLevels levels = some_levels(0);
  float sum = 0;
  for (int look = 1; look <= 50; ++look) {
    const float shown = 0.01F * static_cast<float>(look * look % 37);
    sum += shown;
    levels.correct(kPixel, levels.level(kPixel) - shown);
    levels.settle(kPixel);
    EXPECT_NEAR(levels.level(kPixel), sum / static_cast<float>(look), 1e-5);
  }
}

TEST(PixelLevels, CorrectionsBeforeSettlingCountTogether) {
  // Both events of a batch were loaded with the level as it was before the batch, so both report
  // the same excess: it must not be taken away twice.
  PixelLevels levels = some_levels();
  levels.set(kPixel, 1, 1);
  levels.correct(kPixel, 0.6F);  // by 1/2
  EXPECT_FLOAT_EQ(levels.level(kPixel), 0.7F);
  levels.correct(kPixel, 0.6F);  // of what is left, by 1/3
  EXPECT_FLOAT_EQ(levels.level(kPixel), 0.6F);
  levels.settle(kPixel);
  levels.correct(kPixel, 0.4F);  // anew, by 1/4
  EXPECT_FLOAT_EQ(levels.level(kPixel), 0.5F);
}

TEST(PixelLevels, NoNumberOfCorrectionsOvershoots) {
  PixelLevels levels = some_levels();
  levels.set(kPixel, 1, 0);
  for (int i = 0; i < 30; ++i) levels.correct(kPixel, 1);
  EXPECT_NEAR(levels.level(kPixel), 0, 1e-6);
}

}  // namespace
}  // namespace saccade
