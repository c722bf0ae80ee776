#include "core/blind_time.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/random.h"

namespace saccade {
namespace {

/// Ascending gaps whose part beyond `floor_us` is x^power of `mean_us` times an exponential draw.
std::vector<double> gaps_with_floor(double floor_us, double mean_us, double power,
                                    std::size_t count, std::uint64_t seed = 1) {
  const Random random(seed);
  std::vector<double> gaps;
  for (std::size_t i = 0; i < count; ++i)
    gaps.push_back(floor_us + mean_us * std::pow(-std::log(1 - random.uniform(7, i)), power));
  std::sort(gaps.begin(), gaps.end());
  return gaps;
}

TEST(BlindTime, IsTheFloorOfNoise) {
  // Poisson noise of 100 Hz on a pixel that is blind for 0.5 ms: of 4000 gaps the 200 shortest
  // reach 0.5 ms beyond the floor, evenly, so that the floor's error is about 0.5 / 200 ms.
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const BlindTime blind = blind_time(gaps_with_floor(500, 10'000, 1, 4000, seed));
    ASSERT_TRUE(blind.us);
    EXPECT_NEAR(*blind.us, 500, 25);
    EXPECT_LE(blind.low_us, 505);
    EXPECT_GE(blind.high_us, 495);
  }
}

TEST(BlindTime, IsExtrapolatedFromEdgesThatNeedTime) {
  // The density rises linearly from the floor: no gap reaches it.
  const auto gaps = gaps_with_floor(1900, 3000, 0.5, 20'000);
  ASSERT_GT(gaps.front(), 1900 + 5);
  const BlindTime blind = blind_time(gaps);
  ASSERT_TRUE(blind.us);
  EXPECT_NEAR(*blind.us, 1900, 95);
}

TEST(BlindTime, OutlivesPixelsThatObeyNoFloor) {
  std::vector<double> gaps = gaps_with_floor(1900, 10'000, 1, 20'000);
  const Random random(5);
  for (std::size_t i = 0; i < 100; ++i) gaps.push_back(2200 * random.uniform(1, i) + 1);
  std::sort(gaps.begin(), gaps.end());
  const BlindTime blind = blind_time(gaps);
  ASSERT_TRUE(blind.us);
  EXPECT_NEAR(*blind.us, 1900, 95);
}

TEST(BlindTime, IsNotToldWithoutAFloor) {
  const BlindTime blind = blind_time(gaps_with_floor(0, 10'000, 1, 4000));
  EXPECT_FALSE(blind.us);
  EXPECT_LT(blind.high_us, 100);
}

TEST(BlindTime, IsNotToldByFewGaps) {
  EXPECT_FALSE(blind_time(gaps_with_floor(500, 10'000, 1, 20)).us);
  EXPECT_FALSE(blind_time({}).us);
}

TEST(EventGaps, AreThoseOfOnePixel) {
  const Events events{{0, 1, 1, 1}, {1'000, 2, 1, 1}, {5'000, 1, 1, -1}, {6'500, 2, 1, 1}};
  EXPECT_EQ(event_gaps_us(events, {4, 4}), (std::vector<double>{5, 5.5}));
}

/// The events of 100 x 50 pixels, 150 of each in the mean: from one to the next `blind_us`, and an exponential draw of a
/// time that is the shorter the faster the image moves, of which `edge_part` is the least.
Events events_with_floor(double blind_us, double edge_part, bool is_uniform = false) {
  const Random random(3);
  Events events;
  for (std::uint16_t y = 0; y < 50; ++y)
    for (std::uint16_t x = 0; x < 100; ++x) {
      double t_us = 4000 * random.uniform(100U * y + x, 1'000'000);
      for (std::uint64_t i = 0;; ++i) {
        const double speed = is_uniform ? 1 : 1 + 0.8 * std::sin(t_us / 20'000);
        const double draw = edge_part - std::log(1 - random.uniform(100U * y + x, i));
        t_us += blind_us + 1000 / speed * draw;
        if (t_us > 200'000) break;
        events.push_back({static_cast<TimeNs>(1000 * t_us), x, y, 1});
      }
    }
  std::sort(events.begin(), events.end(), EventOrder());
  return events;
}

TEST(BlindTime, IsFoundFromEventsOfSomePixels) {
  EXPECT_NEAR(find_blind_time_us(events_with_floor(800, 0), {100, 50}), 800, 20);
  EXPECT_EQ(find_blind_time_us(events_with_floor(0, 0), {100, 50}), 0);
  EXPECT_EQ(find_blind_time_us({}, {100, 50}), 0);
}

TEST(BlindTime, IsNotTheTimeThatEdgesTake) {
  EXPECT_EQ(find_blind_time_us(events_with_floor(0, 0.8), {100, 50}), 0);
  // At one speed the two look alike.
  EXPECT_EQ(find_blind_time_us(events_with_floor(800, 0, true), {100, 50}), 0);
}

TEST(BlindTime, IsNotTheSteepestLineBetweenFrames) {
  // From frame to frame, 5 ms later, 1 to 10 events at equal distances where an edge passes, as it does the more often the
  // faster the image moves.
  const Random random(4);
  Events events;
  for (std::uint16_t y = 0; y < 50; ++y)
    for (std::uint16_t x = 0; x < 100; ++x)
      for (std::uint64_t frame = 0; frame < 40; ++frame) {
        const double often = 0.5 + 0.4 * std::sin(0.25 * static_cast<double>(frame));
        if (random.uniform(100U * y + x, 1000 + frame) > often) continue;
        const int count = 1 + static_cast<int>(10 * random.uniform(100U * y + x, frame));
        for (int i = 0; i < count; ++i)
          events.push_back({static_cast<TimeNs>(5e6 * (static_cast<double>(frame) +
                                                       static_cast<double>(i) / count)),
                            x, y, 1});
      }
  std::sort(events.begin(), events.end(), EventOrder());
  EXPECT_EQ(find_blind_time_us(events, {100, 50}), 0);
}

}  // namespace
}  // namespace saccade
