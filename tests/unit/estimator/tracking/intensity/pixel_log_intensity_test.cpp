#include "estimator/tracking/intensity/pixel_log_intensity.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

#include "core/random.h"

namespace saccade {
namespace {

constexpr float kOn = 0.2F;
constexpr float kOff = 0.3F;
constexpr std::size_t kPixel = 5;

PixelLogIntensity some_pixels() {
  PixelLogIntensity pixels(4, 3);
  pixels.set_thresholds(0.2, 0.3);
  return pixels;
}

TEST(PixelLogIntensity, PixelsAreCountedRowByRow) {
  EXPECT_EQ(some_pixels().index({0, 3, 2, 1}), 11U);
  EXPECT_EQ(some_pixels().index({0, 1, 1, 1}), kPixel);
}

TEST(PixelLogIntensity, EventsStepByTheThresholdOfTheirPolarity) {
  PixelLogIntensity pixels = some_pixels();
  pixels.set(kPixel, -1, 0);
  EXPECT_FLOAT_EQ(pixels.add_event(kPixel, 1, 10), -1 + kOn);
  EXPECT_FLOAT_EQ(pixels.add_event(kPixel, 1, 20), -1 + 2 * kOn);
  EXPECT_FLOAT_EQ(pixels.add_event(kPixel, -1, 30), -1 + 2 * kOn - kOff);
  EXPECT_FLOAT_EQ(pixels.add_event(kPixel + 1, -1, 40), -kOff) << "the neighbour has its own";
}

TEST(PixelLogIntensity, RemembersItsLastEvent) {
  PixelLogIntensity pixels = some_pixels();
  EXPECT_EQ(pixels.last_event_ns(kPixel), PixelLogIntensity::kNoEvent);
  pixels.add_event(kPixel, 1, 10);
  pixels.add_event(kPixel, -1, 30);
  EXPECT_EQ(pixels.last_event_ns(kPixel), 30);
  pixels.set(kPixel, 1, 0);
  EXPECT_EQ(pixels.last_event_ns(kPixel), 30) << "reading it from the map is no event";
}

TEST(PixelLogIntensity, KnowsWhetherItHasFiredSinceItWasSet) {
  PixelLogIntensity pixels = some_pixels();
  EXPECT_FALSE(pixels.has_fired(kPixel));
  pixels.add_event(kPixel, -1, 10);
  pixels.correct(kPixel, 0.1F, 0.01F);
  EXPECT_TRUE(pixels.has_fired(kPixel));
  EXPECT_FALSE(pixels.has_fired(kPixel + 1));
  pixels.set(kPixel, 1, 0);
  EXPECT_FALSE(pixels.has_fired(kPixel));
}

TEST(PixelLogIntensity, BetweenEventsAPixelIsHalfwayToTheNextOfItsKind) {
  PixelLogIntensity pixels = some_pixels();
  pixels.set(kPixel, -1, 0);
  EXPECT_EQ(pixels.between_events(kPixel), -1)
      << "before the first event nothing says where it goes";
  pixels.add_event(kPixel, 1, 10);
  EXPECT_FLOAT_EQ(pixels.between_events(kPixel), pixels.at_last_event(kPixel) + kOn / 2);
  pixels.add_event(kPixel, -1, 20);
  EXPECT_FLOAT_EQ(pixels.between_events(kPixel), pixels.at_last_event(kPixel) - kOff / 2);
}

TEST(PixelLogIntensity, ForgettingMakesAllOfThemUnknown) {
  PixelLogIntensity pixels = some_pixels();
  for (std::size_t i = 0; i < 12; ++i) pixels.set(i, 2, 0.1F);
  pixels.reset();
  for (std::size_t i = 0; i < 12; ++i) {
    EXPECT_TRUE(std::isinf(pixels.variance(i)));
    EXPECT_EQ(pixels.at_last_event(i), 0);
  }
}

TEST(PixelLogIntensity, TheFirstMeasurementSetsAnUnknownPixelEntirely) {
  PixelLogIntensity pixels = some_pixels();
  pixels.correct(kPixel, -1.25F, 0.04F);  // the map is brighter by so much
  EXPECT_FLOAT_EQ(pixels.at_last_event(kPixel), 1.25F);
  EXPECT_FLOAT_EQ(pixels.variance(kPixel), 0.04F);
}

TEST(PixelLogIntensity, MeasurementsOfOneVarianceMakeUpTheirMean) {
  PixelLogIntensity pixels = some_pixels();
  float sum = 0;
  for (int count = 1; count <= 50; ++count) {
    const float shown = 0.01F * static_cast<float>(count * count % 37);
    sum += shown;
    pixels.correct(kPixel, pixels.at_last_event(kPixel) - shown, 0.3F);
    EXPECT_NEAR(pixels.at_last_event(kPixel), sum / static_cast<float>(count), 1e-5);
    EXPECT_NEAR(pixels.variance(kPixel), 0.3F / static_cast<float>(count), 1e-5);
  }
}

TEST(PixelLogIntensity, AKnownPixelMovesLessThanItsMeasurement) {
  PixelLogIntensity pixels = some_pixels();
  pixels.set(kPixel, 1, 0.1F);
  pixels.correct(kPixel, 0.8F, 0.3F);
  EXPECT_FLOAT_EQ(pixels.at_last_event(kPixel), 1 - 0.8F * 0.1F / 0.4F);
  EXPECT_FLOAT_EQ(pixels.variance(kPixel), 0.1F * 0.3F / 0.4F);
}

TEST(PixelLogIntensity, EventsOfUnequalThresholdsMakeItLessCertain) {
  PixelLogIntensity pixels = some_pixels();
  pixels.set_event_variance(0.01F);
  pixels.set(kPixel, 0, 0.05F);
  for (int i = 0; i < 4; ++i) pixels.add_event(kPixel, 1, i);
  EXPECT_FLOAT_EQ(pixels.variance(kPixel), 0.05F + 4 * 0.01F);
  pixels.move(kPixel, 0.5F, 0.2F);
  EXPECT_FLOAT_EQ(pixels.variance(kPixel), 0.09F + 0.2F);
  EXPECT_FLOAT_EQ(pixels.at_last_event(kPixel), 4 * kOn + 0.5F);
}

/// A pixel of unequal threshold over many events, measured with noise: the steady error of the
/// filter is that of its own variance.
TEST(PixelLogIntensity, TheVarianceIsThatOfTheError) {
  const Random random(5);
  constexpr double kThresholdSigma = 0.05, kNoise = 0.1;
  double squares = 0;
  double expected = 0;
  constexpr int kPixels = 3000;
  for (std::uint64_t k = 0; k < kPixels; ++k) {
    PixelLogIntensity pixels = some_pixels();
    pixels.set_event_variance(static_cast<float>(kThresholdSigma * kThresholdSigma));
    pixels.set(kPixel, 0, 0);
    double truth = 0;
    for (std::uint64_t event = 0; event < 20; ++event) {
      truth += static_cast<double>(kOn) + kThresholdSigma * random.normal(2 * k, event);
      pixels.add_event(kPixel, 1, 0);
      const double measured = truth + kNoise * random.normal(2 * k + 1, event);
      pixels.correct(kPixel, pixels.at_last_event(kPixel) - static_cast<float>(measured),
                     static_cast<float>(kNoise * kNoise));
    }
    const double error = static_cast<double>(pixels.at_last_event(kPixel)) - truth;
    squares += error * error;
    expected += static_cast<double>(pixels.variance(kPixel));
  }
  // The relative standard deviation of a mean of so many squares is sqrt(2 / n) = 2.6 %.
  EXPECT_NEAR(squares / expected, 1, 0.1);
}

}  // namespace
}  // namespace saccade
