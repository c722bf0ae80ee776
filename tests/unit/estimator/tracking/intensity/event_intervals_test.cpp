#include "estimator/tracking/intensity/event_intervals.h"

#include <gtest/gtest.h>

#include "core/random.h"

namespace saccade {
namespace {

constexpr std::uint64_t kMany = 20000;

TimeNs ns_from_us(double us) { return static_cast<TimeNs>(1e3 * us); }

TEST(EventIntervals, FewSayNothing) {
  EventIntervals intervals;
  for (int i = 0; i < 100; ++i) intervals.add(ns_from_us(500));
  EXPECT_TRUE(intervals.has_bursts());
  EXPECT_EQ(intervals.pile_up(), 0);
  EXPECT_EQ(intervals.shortest_s(), 0);
}

TEST(EventIntervals, BlindPixelsPileUpAboveTheirBlindTime) {
  // A third of the intervals are those of edges that pass while the pixel is blind.
  EventIntervals intervals;
  const Random random(1);
  for (std::uint64_t i = 0; i < kMany; ++i) {
    const double more_us = (i % 3 == 0 ? 100 : 5000) * random.uniform(0, i);
    intervals.add(ns_from_us(500 + more_us));
  }
  EXPECT_FALSE(intervals.has_bursts());
  EXPECT_EQ(intervals.pile_up(), 1);
  EXPECT_NEAR(intervals.shortest_s(), 500e-6, 50e-6);
}

TEST(EventIntervals, SlowTextureDoesNotPileUp) {
  // Steady slopes of all steepnesses: the interval is inversely proportional to a uniform one.
  EventIntervals intervals;
  const Random random(2);
  for (std::uint64_t i = 0; i < kMany; ++i)
    intervals.add(ns_from_us(1000 / (0.01 + random.uniform(0, i) * random.uniform(1, i))));
  EXPECT_FALSE(intervals.has_bursts());
  EXPECT_LT(intervals.pile_up(), 0.1);
}

TEST(EventIntervals, BurstsAreThoseOfIdealPixels) {
  EventIntervals intervals;
  const Random random(3);
  for (std::uint64_t i = 0; i < kMany; ++i)
    intervals.add(i % 20 == 0 ? 0 : ns_from_us(3000 * random.uniform(0, i)));
  EXPECT_TRUE(intervals.has_bursts());
  EXPECT_EQ(intervals.pile_up(), 0);
}

TEST(EventIntervals, WhatWasLongAgoIsForgotten) {
  EventIntervals intervals;
  for (std::uint64_t i = 0; i < kMany; ++i) intervals.add(0);
  ASSERT_TRUE(intervals.has_bursts());
  for (std::uint64_t i = 0; i < 100 * kMany; ++i) intervals.add(ns_from_us(700));
  EXPECT_FALSE(intervals.has_bursts());
}

}  // namespace
}  // namespace saccade
