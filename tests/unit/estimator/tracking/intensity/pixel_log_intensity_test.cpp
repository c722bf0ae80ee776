#include "estimator/tracking/intensity/pixel_log_intensity.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace saccade {
namespace {

constexpr float kOn = 0.2F;
constexpr float kOff = 0.3F;
constexpr std::size_t kPixel = 5;

PixelLogIntensity some_pixels(double correction = 0.1) { return {4, 3, 0.2, 0.3, correction}; }

TEST(PixelLogIntensity, PixelsAreCountedRowByRow) {
  EXPECT_EQ(some_pixels().index({0, 3, 2, 1}), 11U);
  EXPECT_EQ(some_pixels().index({0, 1, 1, 1}), kPixel);
}

TEST(PixelLogIntensity, EventsStepByTheThresholdOfTheirPolarity) {
  PixelLogIntensity pixels = some_pixels();
  pixels.set(kPixel, -1, 3);
  EXPECT_FLOAT_EQ(pixels.add_event(kPixel, 1), -1 + kOn);
  EXPECT_FLOAT_EQ(pixels.add_event(kPixel, 1), -1 + 2 * kOn);
  EXPECT_FLOAT_EQ(pixels.add_event(kPixel, -1), -1 + 2 * kOn - kOff);
  EXPECT_FLOAT_EQ(pixels.add_event(kPixel + 1, -1), -kOff) << "the neighbour has its own";
}

TEST(PixelLogIntensity, BetweenEventsAPixelIsHalfwayToTheNextOfItsKind) {
  PixelLogIntensity pixels = some_pixels();
  pixels.set(kPixel, -1, 3);
  EXPECT_EQ(pixels.between_events(kPixel), -1)
      << "before the first event nothing says where it goes";
  pixels.add_event(kPixel, 1);
  EXPECT_FLOAT_EQ(pixels.between_events(kPixel), pixels.at_last_event(kPixel) + kOn / 2);
  pixels.add_event(kPixel, -1);
  EXPECT_FLOAT_EQ(pixels.between_events(kPixel), pixels.at_last_event(kPixel) - kOff / 2);
}

TEST(PixelLogIntensity, TrustGrowsFromNothingTowardsOne) {
  PixelLogIntensity pixels = some_pixels();
  EXPECT_EQ(pixels.confidence(kPixel), 0);
  pixels.set(kPixel, 0, 10);
  EXPECT_FLOAT_EQ(pixels.confidence(kPixel), 10.0F / 11);
  pixels.correct(kPixel, 0);
  EXPECT_FLOAT_EQ(pixels.confidence(kPixel), 11.0F / 12);
}

TEST(PixelLogIntensity, ForgettingMakesAllOfThemUnknown) {
  PixelLogIntensity pixels = some_pixels();
  for (std::size_t i = 0; i < 12; ++i) pixels.set(i, 2, 4);
  pixels.reset();
  for (std::size_t i = 0; i < 12; ++i) {
    EXPECT_EQ(pixels.confidence(i), 0);
    EXPECT_NEAR(pixels.at_last_event(i), 0, 1e-6);
  }
}

TEST(PixelLogIntensity, TheFirstLookSetsAnUnknownLevelEntirely) {
  PixelLogIntensity pixels = some_pixels();
  pixels.correct(kPixel, -1.25F);  // the map is brighter by so much
  EXPECT_FLOAT_EQ(pixels.at_last_event(kPixel), 1.25F);
}

TEST(PixelLogIntensity, CorrectionsAreAMeanThatTurnsIntoAConstantShare) {
  constexpr double kShare = 0.15;
  PixelLogIntensity pixels = some_pixels(kShare);
  pixels.set(kPixel, 0, 0);
  for (int look = 0; look < 20; ++look) {
    const float before = pixels.at_last_event(kPixel);
    pixels.correct(kPixel, 1);
    pixels.end_batch(kPixel);
    const float share = std::max(static_cast<float>(kShare), 1.0F / static_cast<float>(look + 1));
    EXPECT_NEAR(before - pixels.at_last_event(kPixel), share, 1e-5) << "look " << look;
  }
}

TEST(PixelLogIntensity, WithoutALeastShareALevelIsTheMeanOfWhatTheMapShowed) {
  PixelLogIntensity pixels = some_pixels(0);
  float sum = 0;
  for (int look = 1; look <= 50; ++look) {
    const float shown = 0.01F * static_cast<float>(look * look % 37);
    sum += shown;
    pixels.correct(kPixel, pixels.at_last_event(kPixel) - shown);
    pixels.end_batch(kPixel);
    EXPECT_NEAR(pixels.at_last_event(kPixel), sum / static_cast<float>(look), 1e-5);
  }
}

TEST(PixelLogIntensity, CorrectionsBeforeSettlingCountTogether) {
  // Both events of a batch were loaded with the level as it was before the batch, so both report
  // the same excess: it must not be taken away twice.
  PixelLogIntensity pixels = some_pixels();
  pixels.set(kPixel, 1, 1);
  pixels.correct(kPixel, 0.6F);  // by 1/2
  EXPECT_FLOAT_EQ(pixels.at_last_event(kPixel), 0.7F);
  pixels.correct(kPixel, 0.6F);  // of what is left, by 1/3
  EXPECT_FLOAT_EQ(pixels.at_last_event(kPixel), 0.6F);
  pixels.end_batch(kPixel);
  pixels.correct(kPixel, 0.4F);  // anew, by 1/4
  EXPECT_FLOAT_EQ(pixels.at_last_event(kPixel), 0.5F);
}

TEST(PixelLogIntensity, NoNumberOfCorrectionsOvershoots) {
  PixelLogIntensity pixels = some_pixels();
  pixels.set(kPixel, 1, 0);
  for (int i = 0; i < 30; ++i) pixels.correct(kPixel, 1);
  EXPECT_NEAR(pixels.at_last_event(kPixel), 0, 1e-6);
}

}  // namespace
}  // namespace saccade
