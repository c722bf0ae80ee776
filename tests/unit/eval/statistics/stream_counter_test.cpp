#include "eval/statistics/stream_counter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <span>
#include <utility>
#include <vector>

#include "core/random.h"

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

TEST(StreamCounter, CountsByHand) {
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

TEST(StreamCounter, GapsAreThoseOfOnePixel) {
  const EventGaps gaps = stream_statistics(five_events(), {30, 20}).gaps;
  EXPECT_DOUBLE_EQ(gaps.shortest_us, 3000);
  EXPECT_NEAR(gaps.floor_us, 3000, 3e-4 * 3000);
  EXPECT_NEAR(gaps.median_us, 7000, 3e-4 * 7000);
  EXPECT_DOUBLE_EQ(gaps.opposite_fraction, 0.5);
  const LogHistogram& same = gaps.same;
  const LogHistogram& opposite = gaps.opposite;
  for (std::size_t i = 0; i < same.bins(); ++i) {
    EXPECT_EQ(same.count(i), same.lower(i) <= 3000 && 3000 < same.lower(i + 1) ? 1U : 0U);
    EXPECT_EQ(opposite.count(i), same.lower(i) <= 7000 && 7000 < same.lower(i + 1) ? 1U : 0U);
  }
}

TEST(StreamCounter, RatesOfWholeBins) {
  const std::vector<RateBin> rates = stream_statistics(five_events(), {30, 20}, 0.004).rates;
  ASSERT_EQ(rates.size(), 2U);
  EXPECT_DOUBLE_EQ(rates[0].t_s, 0);
  EXPECT_DOUBLE_EQ(rates[1].t_s, 0.004);
  EXPECT_DOUBLE_EQ(rates[0].on_hz, 750);
  EXPECT_DOUBLE_EQ(rates[1].on_hz, 250);
  EXPECT_DOUBLE_EQ(rates[1].off_hz, 0);
}

TEST(StreamCounter, AnEventIsIsolatedWithoutANeighboursWithinFiveMilliseconds) {
  // The lone pixel's event, and the one 6 ms after its neighbour's. A pixel's own do not count.
  const NoiseSigns noise = stream_statistics(five_events(), {30, 20}).noise;
  EXPECT_DOUBLE_EQ(noise.isolated_fraction, 0.4);
  EXPECT_DOUBLE_EQ(noise.isolated_hz, 2 / 0.01 / 600);
}

TEST(StreamCounter, AHotPixelFiresFarMoreThanItsNeighbours) {
  Events events;
  for (int y = 4; y < 7; ++y)
    for (int x = 4; x < 7; ++x) events.push_back(event_at(0, x, y, 1));
  for (int i = 1; i <= 9; ++i) events.push_back(event_at(i * kMs, 5, 5, 1));
  EXPECT_EQ(stream_statistics(events, {30, 20}).pixels.hot_pixels, 0U);  // 10 are not above 5 * 2
  events.push_back(event_at(10 * kMs, 5, 5, 1));
  EXPECT_EQ(stream_statistics(events, {30, 20}).pixels.hot_pixels, 1U);
}

TEST(StreamCounter, TheQuietestBlockTellsTheNoise) {
  Events events;
  for (int i = 0; i < 300; ++i) events.push_back(event_at(i * kMs, i % 30, i % 10, 1));
  events.push_back(event_at(400 * kMs, 33, 3, 1));
  events.push_back(event_at(500 * kMs, 36, 8, -1));
  events.push_back(event_at(1000 * kMs, 33, 3, 1));
  const NoiseSigns noise = stream_statistics(events, {40, 10}).noise;
  EXPECT_DOUBLE_EQ(noise.quiet_on_hz, 0.02);
  EXPECT_DOUBLE_EQ(noise.quiet_off_hz, 0.01);
}

TEST(StreamCounter, ASensorSmallerThanABlockHasNoQuietPart) {
  const Events events{event_at(0, 0, 0, 1), event_at(kMs, 1, 0, 1)};
  const StreamStatistics s = stream_statistics(events, {2, 1});
  EXPECT_EQ(s.noise.quiet_on_hz, 0);
  EXPECT_EQ(s.gaps.shortest_us, 0);
  EXPECT_TRUE(s.rates.empty());
}

/// Noise without any order but that of time, with many events at one instant.
Events random_events(std::uint64_t count) {
  const Random random(3);
  Events events;
  TimeNs t_ns = 0;
  for (std::uint64_t i = 0; i < count; ++i) {
    if (random.uniform(0, i) < 0.7) t_ns += static_cast<TimeNs>(kMs * random.uniform(1, i));
    events.push_back(event_at(t_ns, static_cast<int>(40 * random.uniform(2, i)),
                              static_cast<int>(30 * random.uniform(3, i)),
                              random.uniform(4, i) < 0.5 ? 1 : -1));
  }
  sort_ties(events);
  return events;
}

TEST(StreamCounter, CountsTheSameInPiecesAndWithoutASize) {
  const Events events = random_events(3000);
  const StreamStatistics whole = stream_statistics(events, {40, 30});
  StreamCounter counter;
  std::span<const Event> rest = events;
  for (std::size_t size = 1; !rest.empty(); size = 2 * size % 611 + 1) {
    const std::size_t count = std::min(size, rest.size());
    counter.add(rest.first(count));
    rest = rest.subspan(count);
  }
  const StreamStatistics pieces = std::move(counter).statistics();
  EXPECT_EQ(pieces.pixels.ascending_hz, whole.pixels.ascending_hz);
  EXPECT_EQ(pieces.pixels.hot_pixels, whole.pixels.hot_pixels);
  EXPECT_EQ(pieces.on_fraction, whole.on_fraction);
  EXPECT_EQ(pieces.pixel_rate_hz, whole.pixel_rate_hz);
  EXPECT_EQ(pieces.noise.isolated_fraction, whole.noise.isolated_fraction);
  EXPECT_EQ(pieces.noise.quiet_on_hz, whole.noise.quiet_on_hz);
  EXPECT_EQ(pieces.gaps.median_us, whole.gaps.median_us);
  EXPECT_EQ(pieces.gaps.floor_us, whole.gaps.floor_us);
  EXPECT_EQ(pieces.gaps.opposite_fraction, whole.gaps.opposite_fraction);
  ASSERT_EQ(pieces.rates.size(), whole.rates.size());
  for (std::size_t i = 0; i < whole.rates.size(); ++i)
    EXPECT_EQ(pieces.rates[i].on_hz, whole.rates[i].on_hz);
}

TEST(StreamCounter, AgreesWithComparingEveryPairOfEvents) {
  const Events events = random_events(3000);
  std::size_t isolated = 0;
  std::vector<double> gaps_us;
  for (std::size_t i = 0; i < events.size(); ++i) {
    const Event& event = events[i];
    bool is_alone = true, is_last = true;
    for (std::size_t k = 0; k < events.size(); ++k) {
      const Event& other = events[k];
      const int dx = std::abs(event.x - other.x), dy = std::abs(event.y - other.y);
      if (std::max(dx, dy) == 1 && std::abs(event.t_ns - other.t_ns) <= 5 * kMs) is_alone = false;
      if (k > i && is_last && dx + dy == 0) {
        gaps_us.push_back(static_cast<double>(other.t_ns - event.t_ns) * 1e-3);
        is_last = false;
      }
    }
    if (is_alone) ++isolated;
  }
  std::sort(gaps_us.begin(), gaps_us.end());
  ASSERT_GT(isolated, 100U);
  ASSERT_LT(isolated, 2900U);
  const StreamStatistics s = stream_statistics(events, {40, 30});
  EXPECT_DOUBLE_EQ(s.noise.isolated_fraction, static_cast<double>(isolated) / 3000);
  EXPECT_EQ(s.gaps.shortest_us, gaps_us.front());
  const double floor_us = gaps_us[gaps_us.size() / 1000], median_us = gaps_us[gaps_us.size() / 2];
  EXPECT_NEAR(s.gaps.floor_us, floor_us, 3e-4 * floor_us);
  EXPECT_NEAR(s.gaps.median_us, median_us, 3e-4 * median_us);
}

}  // namespace
}  // namespace saccade
