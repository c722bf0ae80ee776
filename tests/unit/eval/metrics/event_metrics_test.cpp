#include "eval/metrics/event_metrics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "core/random.h"

namespace saccade {
namespace {

/// A pixel and polarity fires at most every millisecond, so that edits are told apart.
Events sparse_events(std::size_t count) {
  Events events;
  for (std::size_t i = 0; i < count; ++i) {
    const auto cell = static_cast<int>(i % 240);
    events.push_back({static_cast<TimeNs>(i) * 10'000, static_cast<std::uint16_t>(cell % 12),
                      static_cast<std::uint16_t>(cell / 24),
                      static_cast<std::int8_t>(cell / 12 % 2 == 0 ? 1 : -1)});
  }
  return events;
}

Metrics compare(const Events& events, const Events& truth) {
  return score_events({events, {}}, {truth, {}}, match_events(events, truth));
}

TEST(EventMetrics, AStreamAgainstItselfIsPerfect) {
  const Events events = sparse_events(10'000);
  const Metrics scores = compare(events, events);
  for (const char* key : {"events.ratio", "events.precision_1us", "events.recall_1us",
                          "events.precision_100us", "events.on.recall_10us"})
    EXPECT_EQ(scores.get(key), 1) << key;
  EXPECT_EQ(scores.get("events.median_dt_us"), 0);
  EXPECT_EQ(scores.get("events.p99_dt_us"), 0);
}

TEST(EventMetrics, KnownEditsAreMeasuredExactly) {
  const Events truth = sparse_events(100'000);
  Events edited;
  std::size_t flipped = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (i % 100 == 7) continue;  // one in a hundred is dropped
    edited.push_back(truth[i]);
    edited.back().t_ns += 5'000;
    if (i % 1000 != 500) continue;  // one in a thousand is flipped
    edited.back().polarity = static_cast<std::int8_t>(-edited.back().polarity);
    ++flipped;
  }
  ASSERT_EQ(flipped, 100U);
  std::sort(edited.begin(), edited.end(), EventOrder());
  const Metrics scores = compare(edited, truth);
  EXPECT_EQ(scores.get("events.count"), 99'000);
  EXPECT_EQ(scores.get("events.true_count"), 100'000);
  EXPECT_DOUBLE_EQ(*scores.get("events.ratio"), 0.99);
  EXPECT_EQ(scores.get("events.precision_1us"), 0);
  EXPECT_DOUBLE_EQ(*scores.get("events.precision_10us"), 98'900.0 / 99'000);
  EXPECT_DOUBLE_EQ(*scores.get("events.recall_10us"), 0.989);
  EXPECT_DOUBLE_EQ(*scores.get("events.recall_100us"), 0.989);
  EXPECT_DOUBLE_EQ(*scores.get("events.median_dt_us"), 5);
  EXPECT_DOUBLE_EQ(*scores.get("events.median_signed_dt_us"), 5);
  EXPECT_DOUBLE_EQ(*scores.get("events.p99_dt_us"), 5);
}

TEST(EventMetrics, ADroppedEventDoesNotShiftThePairsAfterIt) {
  Events truth;
  for (int k = 0; k < 1000; ++k) truth.push_back({k * 300'000, 3, 4, 1});
  Events edited = truth;
  edited.erase(edited.begin());
  const Metrics scores = compare(edited, truth);
  EXPECT_EQ(scores.get("events.precision_100us"), 1);
  EXPECT_DOUBLE_EQ(*scores.get("events.recall_100us"), 0.999);
  EXPECT_EQ(scores.get("events.p99_dt_us"), 0);
}

TEST(EventMetrics, PairsAreOneToOneWithinTheirPixelAndPolarity) {
  const Events truth{{0, 1, 1, 1}};
  EXPECT_DOUBLE_EQ(*compare({{0, 1, 1, 1}, {500, 1, 1, 1}}, truth).get("events.precision_1us"),
                   0.5);
  EXPECT_EQ(compare({{0, 1, 1, -1}}, truth).get("events.recall_100us"), 0);
  EXPECT_EQ(compare({{0, 1, 2, 1}}, truth).get("events.recall_100us"), 0);
}

TEST(EventMetrics, BothEndsOfATolerancePair) {
  const Events truth{{100'000, 0, 0, 1}};
  EXPECT_EQ(compare({{110'000, 0, 0, 1}}, truth).get("events.recall_10us"), 1);
  EXPECT_EQ(compare({{90'000, 0, 0, 1}}, truth).get("events.recall_10us"), 1);
  EXPECT_EQ(compare({{110'001, 0, 0, 1}}, truth).get("events.recall_10us"), 0);
}

/// As many pairs as the largest matching: dynamic programming over one pixel.
std::size_t largest_matching(const std::vector<TimeNs>& a, const std::vector<TimeNs>& b,
                             TimeNs tolerance_ns) {
  std::vector<std::vector<std::size_t>> best(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 1; i <= a.size(); ++i)
    for (std::size_t k = 1; k <= b.size(); ++k) {
      best[i][k] = std::max(best[i - 1][k], best[i][k - 1]);
      if (std::abs(a[i - 1] - b[k - 1]) <= tolerance_ns)
        best[i][k] = std::max(best[i][k], best[i - 1][k - 1] + 1);
    }
  return best[a.size()][b.size()];
}

TEST(EventMetrics, NoMatchingPairsMore) {
  const Random random(11);
  for (std::uint64_t draw = 0; draw < 200; ++draw) {
    std::array<std::vector<TimeNs>, 2> times;
    std::array<Events, 2> streams;
    for (std::size_t s = 0; s < 2; ++s) {
      const std::size_t count = 1 + random.below(30, 2 * draw + s, 0);
      for (std::size_t i = 0; i < count; ++i)
        times[s].push_back(static_cast<TimeNs>(random.below(200'000, 2 * draw + s, i + 1)));
      std::sort(times[s].begin(), times[s].end());
      for (const TimeNs t_ns : times[s]) streams[s].push_back({t_ns, 0, 0, 1});
    }
    const MatchedEvents matched = match_events(streams[0], streams[1]);
    for (std::size_t k = 0; k < kMatchTolerances.size(); ++k) {
      const auto pairs = static_cast<std::size_t>(
          std::count(matched.first[k].begin(), matched.first[k].end(), true));
      EXPECT_EQ(pairs, largest_matching(times[0], times[1], kMatchTolerances[k].ns));
      EXPECT_EQ(pairs, static_cast<std::size_t>(
                           std::count(matched.second[k].begin(), matched.second[k].end(), true)));
    }
  }
}

TEST(EventMetrics, OriginsAreToldApart) {
  const Events truth{{0, 0, 0, 1}, {1'000'000, 0, 0, 1}, {2'000'000, 0, 0, 1}};
  const std::vector<std::uint8_t> origin{0, 2, 2};
  const Events found{{0, 0, 0, 1}, {2'000'000, 0, 0, 1}};
  const Metrics scores = score_events({found, {}}, {truth, origin}, match_events(found, truth));
  EXPECT_EQ(scores.get("events.origin.signal.recall_10us"), 1);
  EXPECT_DOUBLE_EQ(*scores.get("events.origin.shot.recall_10us"), 0.5);
  EXPECT_FALSE(scores.values().contains("events.origin.hot.recall_10us"));
}

TEST(EventMetrics, WhatCannotBeMeasuredIsNull) {
  const Metrics scores = compare({}, {{0, 0, 0, 1}});
  EXPECT_EQ(scores.get("events.precision_10us"), std::nullopt);
  EXPECT_EQ(scores.get("events.recall_10us"), 0);
  EXPECT_EQ(scores.get("events.median_dt_us"), std::nullopt);
  EXPECT_EQ(compare({{0, 0, 0, 1}}, {}).get("events.ratio"), std::nullopt);
}

}  // namespace
}  // namespace saccade
