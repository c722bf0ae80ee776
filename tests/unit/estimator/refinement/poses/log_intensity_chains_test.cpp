#include "estimator/refinement/poses/log_intensity_chains.h"

#include <gtest/gtest.h>

#include "tests/unit/estimator/refinement/poses/tiny_sensor.h"

namespace saccade {
namespace {

using testing::tiny_camera;

/// Pixel (1, 2) goes up five times and down once, pixel (3, 0) fires once.
Events some_events() {
  Events events = testing::ups_and_downs(5, 1);
  events.push_back({8000000, 3, 0, 1});
  return events;
}

TEST(LogIntensityChains, LevelsAreSumsOfThresholds) {
  const LogIntensityChains levels =
      observe_log_intensity(some_events(), tiny_camera(), {0.2, 0.3}, 200000, 1000);
  EXPECT_EQ(levels.chains, 1U) << "one event says nothing";
  ASSERT_EQ(levels.observations.size(), 6U);
  for (std::size_t i = 0; i < 5; ++i)
    EXPECT_NEAR(levels.observations[i].level, 0.2 * static_cast<double>(i + 1), 1e-12);
  EXPECT_NEAR(levels.observations[5].level, 1.0 - 0.3, 1e-12);
  EXPECT_EQ(levels.observations[5].t_s, 0.006);
  EXPECT_EQ(levels.observations[5].pixel, Eigen::Vector2f(1, 2));
}

TEST(LogIntensityChains, ChainsOfTwoDifferByTheThresholdBetweenThem) {
  const LogIntensityChains levels =
      observe_log_intensity(some_events(), tiny_camera(), {0.2, 0.3}, 200000, 2);
  EXPECT_EQ(levels.chains, 3U);
  for (std::size_t i = 0; i < 6; i += 2) {
    const auto& a = levels.observations[i];
    const auto& b = levels.observations[i + 1];
    EXPECT_EQ(a.chain, b.chain);
    EXPECT_NEAR(b.level - a.level, i < 4 ? 0.2 : -0.3, 1e-12);
  }
}

TEST(LogIntensityChains, SomePixelsKeepAllOfTheirEvents) {
  Events events;
  for (int i = 0; i < 10; ++i)
    for (std::uint16_t y = 0; y < 3; ++y)
      for (std::uint16_t x = 0; x < 4; ++x) events.push_back({1000LL * i, x, y, 1});
  const LogIntensityChains levels =
      observe_log_intensity(events, tiny_camera(), {0.2, 0.3}, 60, 1000);
  EXPECT_GE(levels.chains, 5U);
  EXPECT_LE(levels.chains, 7U);
  EXPECT_EQ(levels.observations.size(), 10 * levels.chains);
}

TEST(LogIntensityChains, NoEventsGiveNone) {
  EXPECT_TRUE(observe_log_intensity({}, tiny_camera(), {}, 200000, 1000).observations.empty());
}

}  // namespace
}  // namespace saccade
