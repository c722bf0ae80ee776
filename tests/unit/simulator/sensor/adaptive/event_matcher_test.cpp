#include "simulator/sensor/adaptive/event_matcher.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace saccade {
namespace {

constexpr TimeNs kEnd_ns = std::numeric_limits<TimeNs>::max() / 2;

MatchCounts match(const std::vector<TimeNs>& exact, const std::vector<TimeNs>& sampled) {
  EventMatcher matcher;
  MatchCounts counts;
  for (const TimeNs t_ns : exact) matcher.add_exact(t_ns);
  for (const TimeNs t_ns : sampled) matcher.add_sampled(t_ns);
  matcher.advance(kEnd_ns, counts);
  return counts;
}

std::vector<TimeNs> every_millisecond(int count) {
  std::vector<TimeNs> times;
  for (int i = 1; i <= count; ++i) times.push_back(2'000'000LL * i);
  return times;
}

TEST(EventMatcher, EqualStreamsMatchThroughout) {
  const std::vector<TimeNs> times = every_millisecond(100);
  const MatchCounts counts = match(times, times);
  for (const std::uint64_t matched : counts.matched) EXPECT_EQ(matched, 100U);
  EXPECT_EQ(counts.dt[0], 100U);
}

TEST(EventMatcher, AShiftCountsWithinItsTolerance) {
  const std::vector<TimeNs> exact = every_millisecond(100);
  std::vector<TimeNs> sampled = exact;
  for (TimeNs& t_ns : sampled) t_ns += 5'000;
  const MatchCounts counts = match(exact, sampled);
  EXPECT_EQ(counts.matched[0], 0U);
  EXPECT_EQ(counts.matched[1], 100U);
  EXPECT_EQ(counts.matched[2], 100U);
  EXPECT_EQ(counts.dt[MatchCounts::bin_of(5'000)], 100U);
  EXPECT_NEAR(MatchCounts::dt_us(MatchCounts::bin_of(5'000)), 5, 0.5);
}

TEST(EventMatcher, DroppedAndAddedEventsHaveNoPartner) {
  const std::vector<TimeNs> exact = every_millisecond(100);
  std::vector<TimeNs> sampled = exact;
  sampled.erase(sampled.begin() + 40);
  sampled.insert(sampled.begin() + 10, (exact[9] + exact[10]) / 2);
  const MatchCounts counts = match(exact, sampled);
  EXPECT_EQ(counts.matched[0], 99U);
  EXPECT_EQ(counts.matched[1], 99U);
}

TEST(EventMatcher, EachEventHasOnePartner) {
  const MatchCounts counts = match({1'000'000, 1'000'000}, {1'000'000});
  EXPECT_EQ(counts.matched[1], 1U);
}

// What is decided does not depend on when it is asked for, nor on an interruption.
TEST(EventMatcher, PartsOfTheStreamsMatchAlike) {
  const std::vector<TimeNs> exact = every_millisecond(50);
  EventMatcher matcher;
  MatchCounts counts;
  for (const TimeNs t_ns : exact) {
    matcher.add_exact(t_ns);
    matcher.advance(t_ns, counts);
    StateWriter state;
    matcher.save(state);
    EventMatcher next;
    StateReader reader(state.bytes());
    next.load(reader);
    EXPECT_TRUE(reader.at_end());
    matcher = next;
    matcher.add_sampled(t_ns + 900);
  }
  matcher.advance(kEnd_ns, counts);
  EXPECT_EQ(counts.matched[0], 50U);
}

}  // namespace
}  // namespace saccade
