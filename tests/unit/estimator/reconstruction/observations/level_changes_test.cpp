#include "estimator/reconstruction/observations/level_changes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "core/image.h"

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

constexpr SensorSize kSensor{128, 96};
constexpr int kChanges = 30;

/// Every pixel gains and loses thresholds by chance, as often the one as the other; of the falls that come within 0.3 ms a
/// part is missing.
Events events_of_chance(double missed_falls) {
  std::mt19937 random(7);
  std::bernoulli_distribution rises(0.5), is_missed(missed_falls), is_quick(0.5);
  Events events;
  for (int i = 0; i < kChanges; ++i)
    for (int y = 0; y < kSensor.height; ++y)
      for (int x = 0; x < kSensor.width; ++x) {
        const bool is_rise = rises(random), comes_quickly = is_quick(random);
        // The times of the pixels in between differ, so that events stay in order.
        const TimeNs t_ns = i * 2'000'000LL - (comes_quickly && i % 2 == 1 ? 1'800'000 : 0);
        if (!is_rise && i % 2 == 1 && comes_quickly && is_missed(random)) continue;
        events.push_back({t_ns, static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y),
                          static_cast<std::int8_t>(is_rise ? 1 : -1)});
      }
  std::stable_sort(events.begin(), events.end(),
                   [](const Event& a, const Event& b) { return a.t_ns < b.t_ns; });
  return events;
}

/// What a pixel gains over the window, mean over the sensor, and the bias that was found.
std::pair<double, LevelBias> mean_gain(const Events& events, bool balanced) {
  LevelChanges changes(kThresholds, 0, balanced);
  changes.weigh(events, kSensor);
  Image<LevelChanges::Pixel> pixels(kSensor.width, kSensor.height);
  double gain = 0;
  for (const Event& event : events)
    gain += static_cast<double>(changes.next(event, pixels(event.x, event.y)));
  return {gain / static_cast<double>(pixels.size()), changes.bias()};
}

TEST(LevelChanges, BalanceWhatFastPixelsMiss) {
  const Events events = events_of_chance(0.3);
  const double unbalanced = mean_gain(events, false).first;
  const auto [balanced, bias] = mean_gain(events, true);
  // 15 odd changes, half of them quick falls' share: 15 x 0.25 x 0.3 thresholds.
  EXPECT_NEAR(unbalanced, 15 * 0.25 * 0.3 * kThresholds.on, 0.02);
  EXPECT_LT(std::abs(balanced), 0.1 * unbalanced);
  EXPECT_GT(bias.per_quick_change, 0.05F);
}

TEST(LevelChanges, OfAFairSensorAreTaken) {
  const LevelBias bias = mean_gain(events_of_chance(0), true).second;
  EXPECT_EQ(bias.per_change, 0);
  EXPECT_EQ(bias.per_quick_change, 0);
  // Four standard deviations of the mean of 12,288 first events.
  EXPECT_NEAR(bias.start, 0, 0.036 * kThresholds.on);
  EXPECT_NEAR(bias.last_polarity, 0, 0.01);
}

TEST(LevelChanges, BeginBelowWhatLeakingPixelsSee) {
  // Nine of ten first events are ON; what comes later is as often of either.
  Events events;
  for (int y = 0; y < kSensor.height; ++y)
    for (int x = 0; x < kSensor.width; ++x) {
      const int first = (x + y) % 10 == 0 ? -1 : 1;
      for (int i = 0; i < 3; ++i)
        events.push_back({i * 3'000'000LL, static_cast<std::uint16_t>(x),
                          static_cast<std::uint16_t>(y),
                          static_cast<std::int8_t>(i == 0             ? first
                                                   : (x + i) % 2 == 0 ? 1
                                                                      : -1)});
    }
  std::stable_sort(events.begin(), events.end(),
                   [](const Event& a, const Event& b) { return a.t_ns < b.t_ns; });
  const LevelBias bias = mean_gain(events, true).second;
  EXPECT_NEAR(bias.start, 0.8 * kThresholds.on, 0.01);
  // For 3 of 6 ms the last event is the first one.
  EXPECT_NEAR(bias.last_polarity, 0.4, 0.02);
  EXPECT_EQ(bias.per_change, 0);
}

TEST(LevelBias, IsNeverMoreThanHalfAChange) {
  LevelBias bias;
  bias.per_quick_change = -9;
  EXPECT_FLOAT_EQ(bias.of(0.2F, 1), -0.1F);
  EXPECT_FLOAT_EQ(bias.of(-0.2F, 0.01F), -0.018F);
  EXPECT_FLOAT_EQ(LevelBias::quickness(100'000), 1);
  EXPECT_FLOAT_EQ(LevelBias::quickness(600'000), 0.5F);
}

}  // namespace
}  // namespace saccade
