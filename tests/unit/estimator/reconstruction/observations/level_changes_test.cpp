#include "estimator/reconstruction/observations/level_changes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
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

/// Every pixel rises and falls by chance, thirty times. In the left half of the sensor every second change comes 0.2 ms after the one
/// before it, in the right half after 2 ms as all others; of the quick falls a part is missing.
Events events_of_chance(double missed_falls) {
  std::mt19937 random(7);
  std::bernoulli_distribution rises(0.5), is_missed(missed_falls);
  Events events;
  for (int i = 0; i < 30; ++i)
    for (int y = 0; y < kSensor.height; ++y)
      for (int x = 0; x < kSensor.width; ++x) {
        const bool is_quick = i % 2 == 1 && x < kSensor.width / 2;
        const bool is_rise = rises(random);
        if (is_quick && !is_rise && is_missed(random)) continue;
        events.push_back({i * 2'000'000LL - (is_quick ? 1'800'000 : 0),
                          static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y),
                          static_cast<std::int8_t>(is_rise ? 1 : -1)});
      }
  std::stable_sort(events.begin(), events.end(),
                   [](const Event& a, const Event& b) { return a.t_ns < b.t_ns; });
  return events;
}

/// What a pixel gains over the window, mean over the sensor.
double mean_gain(const Events& events, bool removes_bias) {
  LevelChanges changes(kThresholds, 0, removes_bias);
  changes.weigh(events, kSensor);
  Image<LevelChanges::Pixel> pixels(kSensor.width, kSensor.height);
  double gain = 0;
  for (const Event& event : events)
    gain += static_cast<double>(changes.next(event, pixels(event.x, event.y)));
  return gain / static_cast<double>(pixels.size());
}

ChangeBias bias_of(const Events& events, SensorSize size = kSensor) {
  LevelChanges changes(kThresholds, 0, true);
  changes.weigh(events, size);
  return changes.bias();
}

TEST(ChangeBias, OfQuickEventsIsFoundAndRemoved) {
  const Events events = events_of_chance(0.3);
  // Of half of the pixels, 15 quick changes, half of them falls, of which 0.3 are missing.
  const double gain = 0.5 * 15 * 0.5 * 0.3 * kThresholds.on;
  EXPECT_NEAR(mean_gain(events, false), gain, 0.02);
  EXPECT_LT(std::abs(mean_gain(events, true)), 0.1 * gain);
  // 0.15 of what would be 1 is missing of 0.85.
  const ChangeBias bias = bias_of(events);
  EXPECT_NEAR(bias.fraction + bias.quick_fraction, 0.15 / 0.85, 0.04);
  // Of those after 2 ms, which are 0.15 quick, nothing is.
  EXPECT_NEAR(bias.fraction + 0.15F * bias.quick_fraction, 0, 0.01);
}

TEST(ChangeBias, OfAFairSensorIsNone) {
  const ChangeBias bias = bias_of(events_of_chance(0));
  EXPECT_EQ(bias.fraction, 0);
  EXPECT_EQ(bias.quick_fraction, 0);
  EXPECT_EQ(bias.start, 0);
  EXPECT_EQ(bias.last_polarity, 0);
  EXPECT_DOUBLE_EQ(mean_gain(events_of_chance(0), true), mean_gain(events_of_chance(0), false));
}

TEST(ChangeBias, OfLeakingPixelsIsTheirStart) {
  // Nine of ten first events are ON; what comes later is as often of either, more often in some parts of the sensor.
  Events events;
  for (int i = 0; i < 7; ++i)
    for (int y = 0; y < kSensor.height; ++y)
      for (int x = 0; x < kSensor.width; ++x) {
        if (i > 4 && x < kSensor.width / 3) continue;
        const int first = (x + 3 * y) % 10 == 0 ? -1 : 1;
        events.push_back({i * 3'000'000LL, static_cast<std::uint16_t>(x),
                          static_cast<std::uint16_t>(y),
                          static_cast<std::int8_t>(i == 0             ? first
                                                   : (x + i) % 2 == 0 ? 1
                                                                      : -1)});
      }
  const ChangeBias bias = bias_of(events);
  EXPECT_NEAR(bias.start, 0.8 * kThresholds.on, 0.005);
  // For 3 of 18 ms the last event is the first one.
  EXPECT_NEAR(bias.last_polarity, 0.8 / 6, 0.04);
  EXPECT_NEAR(bias.fraction, 0, 0.02);
}

TEST(ChangeBias, OfOneEdgeOrFewEventsIsNone) {
  EXPECT_EQ(bias_of({}).start, 0);
  EXPECT_EQ(bias_of({{0, 3, 4, 1}}).start, 0);
  // A bright edge crosses a few pixels; a sensor of one part cannot tell.
  Events edge, small;
  for (std::uint16_t x = 0; x < 10; ++x) edge.push_back({x * 1000LL, x, 50, 1});
  for (std::uint16_t x = 0; x < 10; ++x) small.push_back({x * 1000LL, x, 5, 1});
  EXPECT_EQ(bias_of(edge).start, 0);
  EXPECT_EQ(bias_of(small, {16, 16}).start, 0);
  EXPECT_EQ(bias_of(small, {16, 16}).last_polarity, 0);
}

TEST(ChangeBias, IsNeverMoreThanHalfAChange) {
  ChangeBias bias;
  bias.quick_fraction = -9;
  EXPECT_FLOAT_EQ(bias.of(0.2F, 1), -0.1F);
  EXPECT_FLOAT_EQ(bias.of(-0.2F, 0.01F), -0.018F);
  EXPECT_FLOAT_EQ(ChangeBias::quickness(100'000), 1);
  EXPECT_FLOAT_EQ(ChangeBias::quickness(600'000), 0.5F);
}

}  // namespace
}  // namespace saccade
