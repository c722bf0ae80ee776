#include "estimator/edges/polarity_runs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

namespace saccade {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

PinholeCamera small_camera() {
  PinholeCamera camera;
  camera.width = 4;
  camera.height = 3;
  return camera;
}

Event event(int x, int y, int polarity) {
  Event e;
  e.x = static_cast<std::uint16_t>(x);
  e.y = static_cast<std::uint16_t>(y);
  e.polarity = static_cast<std::int8_t>(polarity);
  return e;
}

TEST(EventSteps, CountsFromATurnOfTheBrightnessOn) {
  const std::vector<Event> events = {event(1, 1, 1),  event(1, 1, 1),  event(1, 1, -1),
                                     event(1, 1, -1), event(1, 1, -1), event(1, 1, 1)};
  EXPECT_THAT(run_positions(events, small_camera()), ElementsAre(0, 0, 1, 2, 3, 1));
}

TEST(EventSteps, EveryPixelCountsForItself) {
  const std::vector<Event> events = {event(0, 0, 1),  event(3, 2, -1), event(0, 0, -1),
                                     event(3, 2, -1), event(0, 0, -1), event(3, 2, 1)};
  EXPECT_THAT(run_positions(events, small_camera()), ElementsAre(0, 0, 1, 0, 2, 1));
}

TEST(EventSteps, StopsCountingAtTheMost) {
  std::vector<Event> events = {event(2, 0, -1)};
  for (int i = 0; i < 7; ++i) events.push_back(event(2, 0, 1));
  EXPECT_THAT(run_positions(events, small_camera()), ElementsAre(0, 1, 2, 3, 4, 4, 4, 4));
}

TEST(EventSteps, NoEventsHaveNone) { EXPECT_THAT(run_positions({}, small_camera()), IsEmpty()); }

TEST(EventSteps, TheirMeanLeavesOutFirstRuns) {
  const std::vector<std::uint8_t> steps = {0, 1, 4, 0, 3};
  EXPECT_EQ(mean_run_position(steps, std::vector<std::uint32_t>{0, 1, 3, 4}), 2);
  EXPECT_EQ(mean_run_position(steps, std::vector<std::uint32_t>{0, 3}), 0);
}

}  // namespace
}  // namespace saccade
