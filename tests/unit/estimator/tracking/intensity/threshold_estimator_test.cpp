#include "estimator/tracking/intensity/threshold_estimator.h"

#include <gtest/gtest.h>

#include "core/random.h"

namespace saccade {
namespace {

TEST(ThresholdEstimator, ExpectsSomethingWithoutEvents) {
  const EventContrast contrast = ThresholdEstimator(4).contrast();
  EXPECT_DOUBLE_EQ(contrast.on, ThresholdEstimator::kExpected.on);
  EXPECT_DOUBLE_EQ(contrast.off, ThresholdEstimator::kExpected.off);
}

TEST(ThresholdEstimator, FindsBothThresholdsFromLevels) {
  // Every pixel goes up by some events and comes down by others; a level is the mean of its events.
  constexpr float kUp = 0.5F, kDown = 0.25F;
  ThresholdEstimator thresholds(1000);
  for (std::size_t pixel = 0; pixel < 1000; ++pixel) {
    float value = 1;
    for (int round = 0; round < 6; ++round) {
      const bool is_up = round % 4 < 2;
      const int events = 1 + static_cast<int>((pixel + static_cast<std::size_t>(round)) % 3);
      thresholds.begin_level(pixel);
      float sum = 0;
      for (int i = 0; i < events; ++i) {
        thresholds.add_event(pixel, is_up ? 1 : -1);
        value += is_up ? kUp : -kDown;
        sum += value;
      }
      thresholds.measure(pixel, sum / static_cast<float>(events), 1);
    }
  }
  EXPECT_NEAR(thresholds.contrast().on, kUp, 0.01);
  EXPECT_NEAR(thresholds.contrast().off, kDown, 0.01);
}

TEST(ThresholdEstimator, ErrorsOfTheMapHardlyPullTheThreshold) {
  const Random random(3);
  ThresholdEstimator thresholds(1);
  float value = 0;
  for (std::uint64_t i = 0; i < 20000; ++i) {
    const int events = 1 + static_cast<int>(3 * random.uniform(i, 0));
    thresholds.begin_level(0);
    for (int k = 0; k < events; ++k) thresholds.add_event(0, 1);
    // A level lies in the middle of its events, the next one begins behind them.
    value += 0.4F * static_cast<float>(events);
    const float middle = value - 0.4F * (static_cast<float>(events) - 1) / 2;
    thresholds.measure(0, middle + 0.1F * static_cast<float>(random.normal(i, 1)), 1);
  }
  EXPECT_NEAR(thresholds.contrast().on, 0.4, 0.02);
}

TEST(ThresholdEstimator, AForgottenLevelSaysNothing) {
  ThresholdEstimator thresholds(1);
  for (int i = 0; i < 1000; ++i) {
    thresholds.begin_level(0);
    thresholds.add_event(0, 1);
    thresholds.measure(0, 7.0F * static_cast<float>(i), 1);
    thresholds.forget(0);
  }
  EXPECT_DOUBLE_EQ(thresholds.contrast().on, ThresholdEstimator::kExpected.on);
}

}  // namespace
}  // namespace saccade
