#include "estimator/odometry/event_clock.h"

#include <gtest/gtest.h>

namespace saccade {
namespace {

TEST(EventClock, AnEventArrivesAsLateAsItWasRecorded) {
  const TimeNs first_ns = 5'000'000'000;
  const EventClock clock(first_ns);
  EXPECT_LT(clock.age_ms(first_ns + 10'000'000'000), 0) << "yet to come";
  const TimeNs event_ns = first_ns + 3'000'000;
  clock.wait_for(event_ns);
  EXPECT_GE(clock.age_ms(event_ns), 0);
  EXPECT_GE(clock.now_ns(), event_ns);
  clock.wait_for(first_ns);
  EXPECT_GE(clock.age_ms(first_ns), 3);
}

}  // namespace
}  // namespace saccade
