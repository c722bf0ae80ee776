#include "estimator/refinement/poses/event_run_observations.h"

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

TEST(EventRunObservations, LevelsAreSumsOfThresholds) {
  const EventRunObservations observed =
      observe_log_intensity(some_events(), tiny_camera(), {0.2, 0.3}, 200000, 1000);
  EXPECT_EQ(observed.runs, 1U) << "one event says nothing";
  ASSERT_EQ(observed.observations.size(), 6U);
  for (std::size_t i = 0; i < 5; ++i)
    EXPECT_NEAR(observed.observations[i].relative_log_intensity, 0.2 * static_cast<double>(i + 1),
                1e-12);
  EXPECT_NEAR(observed.observations[5].relative_log_intensity, 1.0 - 0.3, 1e-12);
  EXPECT_EQ(observed.observations[5].t_s, 0.006);
  EXPECT_EQ(observed.observations[5].pixel, Eigen::Vector2f(1, 2));
}

TEST(EventRunObservations, ChainsOfTwoDifferByTheThresholdBetweenThem) {
  const EventRunObservations observed =
      observe_log_intensity(some_events(), tiny_camera(), {0.2, 0.3}, 200000, 2);
  EXPECT_EQ(observed.runs, 3U);
  for (std::size_t i = 0; i < 6; i += 2) {
    const auto& a = observed.observations[i];
    const auto& b = observed.observations[i + 1];
    EXPECT_EQ(a.run, b.run);
    EXPECT_NEAR(b.relative_log_intensity - a.relative_log_intensity, i < 4 ? 0.2 : -0.3, 1e-12);
  }
}

TEST(EventRunObservations, SomePixelsKeepAllOfTheirEvents) {
  Events events;
  for (int i = 0; i < 10; ++i)
    for (std::uint16_t y = 0; y < 3; ++y)
      for (std::uint16_t x = 0; x < 4; ++x) events.push_back({1000LL * i, x, y, 1});
  const EventRunObservations observed =
      observe_log_intensity(events, tiny_camera(), {0.2, 0.3}, 60, 1000);
  EXPECT_GE(observed.runs, 5U);
  EXPECT_LE(observed.runs, 7U);
  EXPECT_EQ(observed.observations.size(), 10 * observed.runs);
}

TEST(EventRunObservations, NoEventsGiveNone) {
  EXPECT_TRUE(observe_log_intensity({}, tiny_camera(), {}, 200000, 1000).observations.empty());
}

}  // namespace
}  // namespace saccade
