#include "eval/statistics/stream_statistics.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace saccade {
namespace {

constexpr TimeNs kMs = 1'000'000;

Event event_at(TimeNs t_ns, int x, int y, int polarity) {
  return {t_ns, static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y),
          static_cast<std::int8_t>(polarity)};
}

/// Five events: three of a pixel, one of its neighbour, one far from both.
Events five_events() {
  return {event_at(0, 5, 5, 1), event_at(1 * kMs, 20, 15, 1), event_at(3 * kMs, 5, 5, 1),
          event_at(4 * kMs, 6, 5, 1), event_at(10 * kMs, 5, 5, -1)};
}

TEST(StreamStatistics, CountsByHand) {
  const StreamStatistics s = stream_statistics(five_events(), {30, 20});
  EXPECT_EQ(s.events, 5U);
  EXPECT_DOUBLE_EQ(s.duration_s, 0.01);
  EXPECT_DOUBLE_EQ(s.pixel_rate_hz, 5 / 0.01 / 600);
  EXPECT_DOUBLE_EQ(s.on_fraction, 0.8);
  EXPECT_DOUBLE_EQ(s.pixels.silent_fraction, 597.0 / 600);
  ASSERT_EQ(s.pixels.ascending_hz.size(), 600U);
  EXPECT_DOUBLE_EQ(s.pixels.ascending_hz[598], 100);
  EXPECT_DOUBLE_EQ(s.pixels.ascending_hz[599], 300);
}

TEST(StreamStatistics, GapsAreThoseOfOnePixel) {
  const EventGaps gaps = stream_statistics(five_events(), {30, 20}).gaps;
  EXPECT_DOUBLE_EQ(gaps.shortest_us, 3000);
  EXPECT_DOUBLE_EQ(gaps.floor_us, 3000);
  EXPECT_DOUBLE_EQ(gaps.median_us, 7000);
  EXPECT_DOUBLE_EQ(gaps.opposite_fraction, 0.5);
  const LogHistogram& same = gaps.same;
  const LogHistogram& opposite = gaps.opposite;
  for (std::size_t i = 0; i < same.bins(); ++i) {
    EXPECT_EQ(same.count(i), same.lower(i) <= 3000 && 3000 < same.lower(i + 1) ? 1U : 0U);
    EXPECT_EQ(opposite.count(i), same.lower(i) <= 7000 && 7000 < same.lower(i + 1) ? 1U : 0U);
  }
}

TEST(StreamStatistics, RatesOfWholeBins) {
  const std::vector<RateBin> rates = stream_statistics(five_events(), {30, 20}, 0.004).rates;
  ASSERT_EQ(rates.size(), 2U);
  EXPECT_DOUBLE_EQ(rates[0].t_s, 0);
  EXPECT_DOUBLE_EQ(rates[1].t_s, 0.004);
  EXPECT_DOUBLE_EQ(rates[0].on_hz, 750);
  EXPECT_DOUBLE_EQ(rates[1].on_hz, 250);
  EXPECT_DOUBLE_EQ(rates[1].off_hz, 0);
}

TEST(StreamStatistics, AnEventIsIsolatedWithoutANeighboursWithinFiveMilliseconds) {
  // The lone pixel's event, and the one 6 ms after its neighbour's. A pixel's own do not count.
  const NoiseSigns noise = stream_statistics(five_events(), {30, 20}).noise;
  EXPECT_DOUBLE_EQ(noise.isolated_fraction, 0.4);
  EXPECT_DOUBLE_EQ(noise.isolated_hz, 2 / 0.01 / 600);
}

TEST(StreamStatistics, AHotPixelFiresFarMoreThanItsNeighbours) {
  Events events;
  for (int y = 4; y < 7; ++y)
    for (int x = 4; x < 7; ++x) events.push_back(event_at(0, x, y, 1));
  for (int i = 1; i <= 9; ++i) events.push_back(event_at(i * kMs, 5, 5, 1));
  EXPECT_EQ(stream_statistics(events, {30, 20}).pixels.hot_pixels, 0U);  // 10 are not above 5 * 2
  events.push_back(event_at(10 * kMs, 5, 5, 1));
  EXPECT_EQ(stream_statistics(events, {30, 20}).pixels.hot_pixels, 1U);
}

TEST(StreamStatistics, TheQuietestBlockTellsTheNoise) {
  Events events;
  for (int i = 0; i < 300; ++i) events.push_back(event_at(i * kMs, i % 30, i % 10, 1));
  events.push_back(event_at(400 * kMs, 33, 3, 1));
  events.push_back(event_at(500 * kMs, 36, 8, -1));
  events.push_back(event_at(1000 * kMs, 33, 3, 1));
  const NoiseSigns noise = stream_statistics(events, {40, 10}).noise;
  EXPECT_DOUBLE_EQ(noise.quiet_on_hz, 0.02);
  EXPECT_DOUBLE_EQ(noise.quiet_off_hz, 0.01);
}

TEST(StreamStatistics, ASensorSmallerThanABlockHasNoQuietPart) {
  const Events events{event_at(0, 0, 0, 1), event_at(kMs, 1, 0, 1)};
  const StreamStatistics s = stream_statistics(events, {2, 1});
  EXPECT_EQ(s.noise.quiet_on_hz, 0);
  EXPECT_EQ(s.gaps.shortest_us, 0);
  EXPECT_TRUE(s.rates.empty());
}

}  // namespace
}  // namespace saccade
