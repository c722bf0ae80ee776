#include "estimator/reconstruction/observations/level_changes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace saccade {
namespace {

constexpr double kBlind_s = 500e-6;
constexpr ContrastThresholds kThresholds{0.2, 0.2};

/// The events of a pixel that is blind after each: L(t), in ns, is sampled each microsecond.
template <class Level>
Events events_of_blind_pixel(const Level& level, TimeNs end_ns) {
  Events events;
  double reference = level(0);
  TimeNs sees_from_ns = 0;
  for (TimeNs t = 0; t < end_ns; t += 1000) {
    if (t < sees_from_ns) continue;
    if (t == sees_from_ns) reference = level(t);
    const double change = level(t) - reference;
    if (std::abs(change) < kThresholds.on) continue;
    events.push_back({t, 0, 0, static_cast<std::int8_t>(change > 0 ? 1 : -1)});
    sees_from_ns = t + static_cast<TimeNs>(1e9 * kBlind_s);
  }
  return events;
}

/// Log intensities after each event, from 0 before the first one.
std::vector<double> levels_of(const Events& events, double blind_s) {
  LevelChanges changes(kThresholds, blind_s);
  changes.weigh(events, {1, 1});
  LevelChanges::Pixel pixel;
  std::vector<double> levels;
  double level = 0;
  for (const Event& event : events)
    levels.push_back(level += static_cast<double>(changes.next(event, pixel)));
  return levels;
}

/// Up by 3 and down again within 20 ms, five times, smoothly.
double hills(TimeNs t_ns) {
  const double phase = 2 * 3.14159265358979 * static_cast<double>(t_ns) / 20e6;
  return 1.5 * (1 - std::cos(phase));
}

TEST(LevelChanges, AreThresholdsOfPixelsThatAlwaysSee) {
  const Events events{{0, 0, 0, 1}, {1000, 0, 0, 1}, {2000, 0, 0, -1}};
  LevelChanges changes({0.2, 0.3}, 0);
  changes.weigh(events, {1, 1});
  LevelChanges::Pixel pixel;
  EXPECT_FLOAT_EQ(changes.next(events[0], pixel), 0.2F);
  EXPECT_FLOAT_EQ(changes.next(events[1], pixel), 0.2F);
  EXPECT_FLOAT_EQ(changes.next(events[2], pixel), -0.3F);
}

TEST(LevelChanges, HoldWhatABlindPixelMissesOnSmoothSlopes) {
  const Events events = events_of_blind_pixel(hills, 100'000'000);
  ASSERT_GT(events.size(), 50U);
  // What thresholds alone make of a hill of 3, and what is left with the missed changes.
  const auto largest_error = [&](double blind_s) {
    const std::vector<double> levels = levels_of(events, blind_s);
    double largest = 0;
    for (std::size_t i = 0; i < events.size(); ++i)
      largest = std::max(largest, std::abs(levels[i] - hills(events[i].t_ns)));
    return largest;
  };
  EXPECT_GT(largest_error(0), 0.5);
  EXPECT_LT(largest_error(kBlind_s), 0.5 * largest_error(0));
}

TEST(LevelChanges, RisesAndFallsOfAWindowCancelOut) {
  // In the light, an edge of ten to one that passes within 2 ms is steeper at its dark end.
  const auto edges = [](TimeNs t_ns) {
    const double phase = 2 * 3.14159265358979 * static_cast<double>(t_ns) / 8e6;
    return std::log(0.1 + 0.5 * (1 - std::cos(phase)));
  };
  const Events events = events_of_blind_pixel(edges, 400'000'000);
  const std::vector<double> levels = levels_of(events, kBlind_s);
  // Of fifty of them the sum stays within one.
  EXPECT_LT(std::abs(levels.back()), std::log(11.0));
  EXPECT_GT(*std::max_element(levels.begin(), levels.end()) -
                *std::min_element(levels.begin(), levels.end()),
            1);
}

TEST(LevelChanges, AreThresholdsWherePolaritiesSayNothingOfTheSlope) {
  // Texture that passes within the blind time: polarities in turn, rises sooner than falls.
  Events events;
  TimeNs t_ns = 0;
  for (int i = 0; i < 100; ++i) {
    const bool is_rise = i % 2 == 0;
    t_ns += is_rise ? 550'000 : 900'000;
    events.push_back({t_ns, 0, 0, static_cast<std::int8_t>(is_rise ? 1 : -1)});
  }
  const std::vector<double> levels = levels_of(events, kBlind_s);
  for (std::size_t i = 0; i < levels.size(); ++i)
    EXPECT_NEAR(levels[i], i % 2 == 0 ? 0.2 : 0, 1e-5) << i;
}

TEST(LevelChanges, DoNotTakeAStepForASteepRamp) {
  // Twenty events up and twenty down, each right after the blind time.
  Events events;
  for (int i = 0; i < 40; ++i)
    events.push_back({i * 510'000LL, 0, 0, static_cast<std::int8_t>(i < 20 ? 1 : -1)});
  const std::vector<double> levels = levels_of(events, kBlind_s);
  const double highest = *std::max_element(levels.begin(), levels.end());
  // A threshold and what half the blind time as seen makes of it: two more.
  EXPECT_GT(highest, 20 * 0.2 * 2);
  EXPECT_LT(highest, 20 * 0.2 * 3.2);
}

}  // namespace
}  // namespace saccade
