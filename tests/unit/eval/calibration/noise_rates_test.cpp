#include "eval/calibration/noise_rates.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/random.h"

namespace saccade {
namespace {

constexpr SensorSize kSize{60, 40};

/// Poisson noise of every pixel, ON and OFF at their own rates.
void add_noise(double on_hz, double off_hz, double duration_s, Events& events,
               std::uint64_t seed = 1) {
  const Random random(seed);
  for (int y = 0; y < kSize.height; ++y)
    for (int x = 0; x < kSize.width; ++x) {
      const auto stream = static_cast<std::uint64_t>(y * kSize.width + x);
      double t_s = 0;
      for (std::uint64_t i = 0;; i += 2) {
        t_s -= std::log(1 - random.uniform(stream, i)) / (on_hz + off_hz);
        if (t_s >= duration_s) break;
        const bool is_on = random.uniform(stream, i + 1) < on_hz / (on_hz + off_hz);
        events.push_back({ns_from_seconds(t_s), static_cast<std::uint16_t>(x),
                          static_cast<std::uint16_t>(y), static_cast<std::int8_t>(is_on ? 1 : -1)});
      }
    }
}

/// An edge that passes over the left half of the sensor and back, again and again.
void add_edge(double duration_s, Events& events) {
  constexpr double kSpeed_px_s = 400;
  for (double t_s = 0; t_s < duration_s; t_s += 1 / kSpeed_px_s) {
    const int phase = static_cast<int>(t_s * kSpeed_px_s) % kSize.width;
    const int x = phase < kSize.width / 2 ? phase : kSize.width - 1 - phase;
    for (int y = 0; y < kSize.height; ++y)
      events.push_back(
          {ns_from_seconds(t_s), static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y), 1});
  }
}

TEST(NoiseRates, AreThoseOfAStillScene) {
  Events events;
  add_noise(0.3, 0.1, 3, events);
  std::sort(events.begin(), events.end(), EventOrder{});
  // 2160 ON and 720 OFF events in all: one sigma is 2 and 4 %.
  const NoiseRates rates = noise_rates(events, kSize);
  EXPECT_NEAR(rates.on.hz / 0.3, 1, 0.1);
  EXPECT_NEAR(rates.off.hz / 0.1, 1, 0.2);
  EXPECT_LT(rates.on.low_hz, 0.3);
  EXPECT_GT(rates.on.high_hz, 0.3);
  EXPECT_TRUE(rates.hot.empty());
}

TEST(NoiseRates, AreTheSameBesideWhatMoves) {
  Events events;
  add_noise(0.3, 0.1, 30, events);
  add_edge(30, events);
  std::sort(events.begin(), events.end(), EventOrder{});
  // Far from the edge alone, some 600 ON and 200 OFF events: 15 and 20 % are three sigma.
  const NoiseRates rates = noise_rates(events, kSize);
  EXPECT_TRUE(rates.is_told);
  EXPECT_LT(rates.quiet_fraction, 0.6);
  EXPECT_NEAR(rates.on.hz / 0.3, 1, 0.15);
  EXPECT_NEAR(rates.off.hz / 0.1, 1, 0.2);
}

TEST(NoiseRates, LeaveHotPixelsOut) {
  Events events;
  add_noise(0.3, 0.1, 3, events);
  for (int k = 0; k < 150; ++k) events.push_back({k * 20'000'000LL, 31, 17, 1});
  std::sort(events.begin(), events.end(), EventOrder{});
  const NoiseRates rates = noise_rates(events, kSize);
  ASSERT_EQ(rates.hot.size(), 1U);
  EXPECT_EQ(rates.hot[0].x, 31);
  EXPECT_EQ(rates.hot[0].y, 17);
  EXPECT_NEAR(rates.hot[0].hz, 50, 8);
  EXPECT_NEAR(rates.on.hz / 0.3, 1, 0.1);
}

TEST(CountedRate, HasTheExactIntervalOfAPoissonCount) {
  // Exact 95 % limits of 10 events: 4.80 and 18.39; of none: 0 and 3.69.
  const CountedRate ten = counted_rate(10, 2);
  EXPECT_DOUBLE_EQ(ten.hz, 5);
  EXPECT_NEAR(ten.low_hz, 2.40, 0.02);
  EXPECT_NEAR(ten.high_hz, 9.20, 0.02);
  const CountedRate none = counted_rate(0, 1);
  EXPECT_EQ(none.low_hz, 0);
  EXPECT_NEAR(none.high_hz, 3.69, 0.1);
}

}  // namespace
}  // namespace saccade
