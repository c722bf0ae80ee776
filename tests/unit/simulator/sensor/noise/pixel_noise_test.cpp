#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "simulator/sensor/event_options.h"
#include "simulator/sensor/noise/leak.h"
#include "simulator/sensor/noise/mismatch.h"
#include "simulator/sensor/noise/spontaneous_events.h"
#include "tests/unit/simulator/sensor/noise/log_eps.h"
#include "tests/unit/simulator/sensor/noise/statistics.h"

namespace saccade {
namespace {

using testing::kLogEps;

constexpr int kWidth = 240;
constexpr int kHeight = 180;
constexpr std::uint64_t kSeed = 11;

/// `of(x, y)` for every pixel, row by row.
template <class Function>
std::vector<double> over_pixels(int width, int height, const Function& of) {
  std::vector<double> values;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      values.push_back(of(static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y)));
  return values;
}

/// Mean and standard deviation of independent normal draws, within kSigmas.
void expect_normal(const std::vector<double>& values, double mean, double sigma) {
  const auto count = static_cast<double>(values.size());
  const Moments moments = moments_of(values);
  EXPECT_NEAR(moments.mean, mean, kSigmas * sigma / std::sqrt(count));
  const double chi_square = (count - 1) * moments.variance / (sigma * sigma);
  EXPECT_GT(chi_square, chi_square_bound(count - 1, -kSigmas));
  EXPECT_LT(chi_square, chi_square_bound(count - 1, kSigmas));
}

TEST(Mismatch, HasTheStatedSpreadOnBothSidesApart) {
  EventOptions options;
  options.contrast = {0.2, 0.3};
  options.noise.mismatch.sigma = 0.15;
  const auto on = over_pixels(kWidth, kHeight, [&](auto x, auto y) {
    return pixel_contrast(options.noise.mismatch, options.contrast, kSeed, x, y).on;
  });
  const auto off = over_pixels(kWidth, kHeight, [&](auto x, auto y) {
    return pixel_contrast(options.noise.mismatch, options.contrast, kSeed, x, y).off;
  });
  expect_normal(on, 0.2, 0.2 * 0.15);
  expect_normal(off, 0.3, 0.3 * 0.15);
  double product = 0;
  for (std::size_t i = 0; i < on.size(); ++i) product += (on[i] / 0.2 - 1) * (off[i] / 0.3 - 1);
  const auto count = static_cast<double>(on.size());
  EXPECT_LT(std::abs(product), kSigmas * 0.15 * 0.15 * std::sqrt(count));
}

TEST(Mismatch, KeepsEveryThresholdAboveTheFloor) {
  EventOptions options;
  options.contrast = {0.2, 0.2};
  options.noise.mismatch.sigma = 0.5;
  int at_floor = 0;
  for (const double on : over_pixels(kWidth, kHeight, [&](auto x, auto y) {
         return pixel_contrast(options.noise.mismatch, options.contrast, kSeed, x, y).on;
       })) {
    ASSERT_GE(on, kLeastContrast * 0.2);
    at_floor += on == kLeastContrast * 0.2 ? 1 : 0;
  }
  const double share = normal_share_below((kLeastContrast - 1) / 0.5);
  const double expected = share * kWidth * kHeight;
  EXPECT_NEAR(at_floor, expected, kSigmas * std::sqrt(expected * (1 - share)));
}

TEST(Leak, SlopesHaveTheStatedRateAndSpread) {
  const LeakOptions options{0.5, 0.2};
  const double contrast_on = 0.25;
  const auto rates = over_pixels(kWidth, kHeight, [&](auto x, auto y) {
    return leak_slope(options, contrast_on, kSeed, x, y) / contrast_on;
  });
  expect_normal(rates, 0.5, 0.5 * 0.2);
  EXPECT_EQ(leak_slope({0.5, 0}, contrast_on, kSeed, 3, 4), contrast_on * 0.5);
  for (const double slope : over_pixels(kWidth, kHeight, [&](auto x, auto y) {
         return leak_slope({0.5, 1}, contrast_on, kSeed, x, y);
       }))
    ASSERT_GE(slope, 0);
}

/// Accepted events of a pixel before a constant signal up to a time.
std::vector<SpontaneousCandidate> fired(const SpontaneousEvents& events, std::uint16_t x,
                                        std::uint16_t y, double duration_s, double log_intensity) {
  std::vector<SpontaneousCandidate> fired;
  SpontaneousState state = events.start(x, y, 0);
  while (state.next_s() < duration_s) {
    const SpontaneousCandidate candidate = events.next_candidate(state, x, y);
    if (events.accepts(candidate, log_intensity)) fired.push_back(candidate);
  }
  return fired;
}

NoiseOptions shot_noise(double rate_hz) {
  NoiseOptions options;
  options.shot.rate_hz = rate_hz;
  return options;
}

TEST(ShotNoise, CountsAreDispersedLikePoissonAtTheRateOfTheRadiance) {
  const double duration_s = 2;
  const SpontaneousEvents events(shot_noise(20), kLogEps, kSeed);
  for (const double radiance : {0.0, 0.3, 1.0, 7.0}) {
    const double log_intensity = std::log(radiance + kLogEps);
    const double rate_hz = 20 * (1 - 0.75 * std::min(1.0, radiance));
    EXPECT_NEAR(events.shot_rate_hz(log_intensity), rate_hz, 1e-9);
    const auto counts = over_pixels(60, 60, [&](auto x, auto y) {
      return static_cast<double>(fired(events, x, y, duration_s, log_intensity).size());
    });
    const auto pixels = static_cast<double>(counts.size());
    const double expected = rate_hz * duration_s;
    const Moments moments = moments_of(counts);
    EXPECT_NEAR(moments.mean, expected, kSigmas * std::sqrt(expected / pixels)) << radiance;
    const double dispersion = (pixels - 1) * moments.variance / moments.mean;
    EXPECT_GT(dispersion, chi_square_bound(pixels - 1, -kSigmas)) << radiance;
    EXPECT_LT(dispersion, chi_square_bound(pixels - 1, kSigmas)) << radiance;
  }
}

TEST(ShotNoise, GapsAreExponentialAndPolaritiesFair) {
  const SpontaneousEvents events(shot_noise(50), kLogEps, kSeed);
  constexpr int kBins = 20;
  std::array<double, kBins> bins{};
  double count = 0;
  double ons = 0;
  double on_after_on = 0;
  for (std::uint16_t x = 0; x < 100; ++x) {
    double before_s = 0;
    bool was_on = false;
    for (const SpontaneousCandidate& event : fired(events, x, 7, 20, 0)) {
      const double share = -std::expm1(-events.shot_rate_hz(0) * (event.t_s - before_s));
      ++bins[static_cast<std::size_t>(std::min(kBins - 1, static_cast<int>(kBins * share)))];
      before_s = event.t_s;
      ++count;
      ons += event.polarity > 0 ? 1 : 0;
      on_after_on += was_on && event.polarity > 0 ? 1 : 0;
      was_on = event.polarity > 0;
      ASSERT_EQ(event.origin, EventOrigin::kShot);
    }
  }
  double chi_square = 0;
  for (const double bin : bins)
    chi_square += (bin - count / kBins) * (bin - count / kBins) / (count / kBins);
  EXPECT_LT(chi_square, chi_square_bound(kBins - 1, kSigmas));
  EXPECT_NEAR(ons, 0.5 * count, kSigmas * 0.5 * std::sqrt(count));
  EXPECT_NEAR(on_after_on, 0.25 * count, kSigmas * std::sqrt(count));
}

TEST(ShotNoise, FollowsASignalThatChanges) {
  // Dark in the first quarter of every 100 ms, white in the rest.
  const SpontaneousEvents events(shot_noise(40), kLogEps, kSeed);
  const double duration_s = 5;
  double dark = 0;
  double bright = 0;
  for (std::uint16_t x = 0; x < 200; ++x) {
    SpontaneousState state = events.start(x, 0, 0);
    while (state.next_s() < duration_s) {
      const SpontaneousCandidate candidate = events.next_candidate(state, x, 0);
      const bool is_dark = std::fmod(candidate.t_s, 0.1) < 0.025;
      if (events.accepts(candidate, std::log(kLogEps + (is_dark ? 0 : 1))))
        ++(is_dark ? dark : bright);
    }
  }
  const double expected_dark = 200 * duration_s * 0.25 * 40;
  const double expected_bright = 200 * duration_s * 0.75 * 10;
  EXPECT_NEAR(dark, expected_dark, kSigmas * std::sqrt(expected_dark));
  EXPECT_NEAR(bright, expected_bright, kSigmas * std::sqrt(expected_bright));
}

TEST(ShotNoise, SavedStateGoesOnWithTheSameCandidates) {
  const SpontaneousEvents events(shot_noise(50), kLogEps, kSeed);
  SpontaneousState state = events.start(3, 4, 0);
  for (int i = 0; i < 10; ++i) events.next_candidate(state, 3, 4);
  SpontaneousState copy = state;
  for (int i = 0; i < 10; ++i)
    EXPECT_EQ(events.next_candidate(state, 3, 4).t_s, events.next_candidate(copy, 3, 4).t_s);
}

TEST(HotPixels, AreTheStatedFractionWithLogNormalRates) {
  NoiseOptions options;
  options.hot = {0.05, 40, 0.5};
  const SpontaneousEvents events(options, kLogEps, kSeed);
  std::vector<double> logs;
  for (const double rate_hz :
       over_pixels(kWidth, kHeight, [&](auto x, auto y) { return events.hot_rate_hz(x, y); }))
    if (rate_hz > 0) logs.push_back(std::log(rate_hz));
  const double pixels = kWidth * kHeight;
  EXPECT_NEAR(static_cast<double>(logs.size()), 0.05 * pixels,
              kSigmas * std::sqrt(0.05 * 0.95 * pixels));
  expect_normal(logs, std::log(40), 0.5);
}

TEST(HotPixels, FireOnEventsAtTheirRateAndTheOthersNever) {
  NoiseOptions options;
  options.hot = {0.3, 40, 0.5};
  const SpontaneousEvents events(options, kLogEps, kSeed);
  for (std::uint16_t x = 0; x < 50; ++x) {
    const auto events_of_pixel = fired(events, x, 9, 20, 0);
    const double expected = 20 * events.hot_rate_hz(x, 9);
    EXPECT_NEAR(static_cast<double>(events_of_pixel.size()), expected,
                kSigmas * std::sqrt(expected));
    for (const SpontaneousCandidate& event : events_of_pixel) {
      ASSERT_EQ(event.origin, EventOrigin::kHot);
      ASSERT_EQ(event.polarity, 1);
    }
  }
}

TEST(SpontaneousEvents, ModelsDoNotDisturbEachOther) {
  NoiseOptions both = shot_noise(30);
  both.hot = {1, 40, 0.5};
  const auto with_hot = fired(SpontaneousEvents(both, kLogEps, kSeed), 5, 6, 10, 0);
  std::vector<double> shots;
  double before_s = 0;
  for (const SpontaneousCandidate& event : with_hot) {
    ASSERT_GE(event.t_s, before_s);
    before_s = event.t_s;
    if (event.origin == EventOrigin::kShot) shots.push_back(event.t_s);
  }
  std::vector<double> alone;
  for (const auto& event : fired(SpontaneousEvents(shot_noise(30), kLogEps, kSeed), 5, 6, 10, 0))
    alone.push_back(event.t_s);
  EXPECT_EQ(shots, alone);
  EXPECT_GT(with_hot.size(), shots.size());
}

}  // namespace
}  // namespace saccade
