#include "core/time_search.h"

#include <gtest/gtest.h>

#include <functional>
#include <vector>

namespace saccade {
namespace {

Events events_at(const std::vector<TimeNs>& times) {
  Events events;
  for (const TimeNs t : times) events.push_back({.t_ns = t});
  return events;
}

std::vector<TimeNs> times_of(std::span<const Event> events) {
  std::vector<TimeNs> times;
  for (const Event& event : events) times.push_back(event.t_ns);
  return times;
}

using Times = std::vector<TimeNs>;

TEST(TimeSearch, EqualTimesCountUntilButNotBefore) {
  const Events events = events_at({1, 3, 3, 3, 7});
  EXPECT_EQ(count_before(events, 3), 1U);
  EXPECT_EQ(count_until(events, 3), 4U);
  EXPECT_EQ(count_before(events, 4), 4U);
  EXPECT_EQ(count_until(events, 4), 4U);
  EXPECT_EQ(count_before(events, 0), 0U);
  EXPECT_EQ(count_until(events, 8), 5U);
  EXPECT_EQ(count_until(Events{}, 8), 0U);
}

TEST(TimeSearch, BetweenLeavesTheEndOutAndWithinTakesItIn) {
  const Events events = events_at({1, 3, 3, 5, 7});
  EXPECT_EQ(times_of(events_between(events, 3, 5)), (Times{3, 3}));
  EXPECT_EQ(times_of(events_within(events, 3, 5)), (Times{3, 3, 5}));
  EXPECT_EQ(times_of(events_between(events, 4, 4)), Times{});
  EXPECT_EQ(times_of(events_within(events, 4, 4)), Times{});
}

TEST(TimeSearch, AnEndBeforeTheBeginIsEmpty) {
  const Events events = events_at({1, 3, 5, 7});
  EXPECT_TRUE(events_between(events, 6, 2).empty());
  EXPECT_TRUE(events_within(events, 6, 2).empty());
}

TEST(TimeSearch, TakesAnyOrderedItems) {
  struct Item {
    double t_s;
  };
  const std::vector<Item> items{{0.5}, {1.5}};
  EXPECT_EQ(count_before(items, 1.5, &Item::t_s), 1U);
  EXPECT_EQ(count_until(items, 1.5, &Item::t_s), 2U);
  EXPECT_EQ(count_before(Times{1, 2, 2}, TimeNs{2}, std::identity{}), 1U);
}

}  // namespace
}  // namespace saccade
