#include "eval/calibration/blind_time.h"

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

}  // namespace
}  // namespace saccade
