#include "estimator/edges/path/batch_adjustment.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace saccade {
namespace {

using ::testing::DoubleNear;
using ::testing::ElementsAre;

TEST(ViewsAlong, LeaveNoGapAndReachTheEnd) {
  EXPECT_THAT(batch_views({0.1, 1.1}, 2.1, 1.5),
              ElementsAre(0.1, DoubleNear(0.6, 1e-12), 1.1, DoubleNear(1.6, 1e-12)));
  EXPECT_THAT(batch_views({0.3}, 0.75, 1.5), ElementsAre(0.3)) << "near the end already";
}

TEST(ViewsAlong, AreNotCrowded) {
  EXPECT_THAT(batch_views({0.1, 0.2, 0.45, 0.5, 0.8, 1.0}, 1.2, 1.2),
              ElementsAre(0.1, DoubleNear(0.45, 1e-12), DoubleNear(0.8, 1e-12)));
}

TEST(EventsAround, AreThoseOfTheWindow) {
  Events events;
  for (int i = 0; i < 10; ++i) events.push_back({ns_from_seconds(0.1 * i), 0, 0, 1});
  const auto some = events_of_view(events, 0.5, 0.4);
  ASSERT_EQ(some.size(), 4U);
  EXPECT_EQ(some.front().t_ns, ns_from_seconds(0.3));
  EXPECT_TRUE(events_of_view(events, 5, 1).empty());
}

}  // namespace
}  // namespace saccade
