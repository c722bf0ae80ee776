#include "eval/calibration/sensor_fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/random.h"

namespace saccade {
namespace {

constexpr SensorSize kFittedSize{48, 32};
constexpr double kDuration_s = 0.12;

/// A world without a simulator: every pixel sees a sum of two sines, sampled every 40 us.
struct SinePixels {
  std::uint64_t seed = 1;

  [[nodiscard]] Events operator()(const SensorParameters& sensor) const {
    Events events;
    for (int y = 0; y < kFittedSize.height; ++y)
      for (int x = 0; x < kFittedSize.width; ++x) sense(x, y, seed, sensor, events);
    std::sort(events.begin(), events.end(), EventOrder{});
    return events;
  }

 private:
  static void sense(int x, int y, std::uint64_t seed, const SensorParameters& sensor,
                    Events& events) {
    constexpr TimeNs kStepNs = 40'000;
    const Random random(seed);
    const auto stream = static_cast<std::uint64_t>(y * kFittedSize.width + x);
    // Neighbours see nearly the same: waves that pass, of another kind in every part.
    const auto kind = static_cast<double>(seed % 97);
    const double amplitude = 0.9 + 0.5 * std::sin(0.11 * x + 0.17 * y + kind);
    const double hz = 25 + 12 * std::sin(0.07 * x - 0.13 * y + 2 * kind);
    const double phase = 0.35 * x + 0.2 * y + 3 * kind;
    const double sigma = sensor.mismatch_sigma.value_or(0);
    const double on = *sensor.contrast_on * std::max(0.1, 1 + sigma * random.normal(stream, 10));
    const double off = *sensor.contrast_off * std::max(0.1, 1 + sigma * random.normal(stream, 11));
    const auto blind_ns = static_cast<TimeNs>(1e3 * sensor.refractory_us.value_or(0));
    const auto signal = [&](TimeNs t_ns) {
      const double angle = 6.2832 * hz * seconds_from_ns(t_ns) + phase;
      return amplitude * (std::sin(angle) + 0.4 * std::sin(2.7 * angle));
    };
    double reference = signal(0);
    TimeNs blind_until_ns = -1;
    for (TimeNs t_ns = 0; t_ns < ns_from_seconds(kDuration_s); t_ns += kStepNs) {
      const double value = signal(t_ns);
      if (t_ns < blind_until_ns) continue;
      if (blind_until_ns >= 0) reference = value;
      blind_until_ns = -1;
      const int polarity = value >= reference + on ? 1 : value <= reference - off ? -1 : 0;
      if (polarity == 0) continue;
      events.push_back({t_ns, static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y),
                        static_cast<std::int8_t>(polarity)});
      blind_until_ns = t_ns + blind_ns;
    }
  }
};

RepeatedRecording recording_of(const SensorParameters& truth, std::uint64_t seed = 1) {
  return {"sines", kFittedSize, kDuration_s, SinePixels{seed}(truth), SinePixels{seed}};
}

SensorParameters start() {
  SensorParameters sensor;
  sensor.contrast_on = sensor.contrast_off = 0.25;
  sensor.refractory_us = 1400;  // as the floor of the gaps tells it, within 10 %
  sensor.mismatch_sigma = 0.05;
  return sensor;
}

TEST(SensorFit, FindsTheSensorOfAWorldThatItKnows) {
  SensorParameters truth;
  truth.contrast_on = 0.33;
  truth.contrast_off = 0.16;
  truth.refractory_us = 1500;
  truth.mismatch_sigma = 0.12;
  const std::vector<RepeatedRecording> recordings{recording_of(truth)};
  SensorFitOptions options;
  options.fits_cutoff = false;
  const SensorFit fit = fit_sensor(recordings, start(), options);
  // The world is known exactly, with the draws of the same seed: what remains is the tolerance of the
  // fit, a third of a percent, and the 40 us of the pixels' clock.
  EXPECT_NEAR(*fit.sensor.contrast_on / 0.33, 1, 0.02);
  EXPECT_NEAR(*fit.sensor.contrast_off / 0.16, 1, 0.02);
  EXPECT_NEAR(*fit.sensor.refractory_us, 1500, 60);
  EXPECT_NEAR(*fit.sensor.mismatch_sigma, 0.12, 0.03);
  ASSERT_EQ(fit.distances.size(), 1U);
  EXPECT_NEAR(fit.distances[0].event_ratio, 1, 0.02);
  EXPECT_LT(fit.distances[0].gap_decades, 0.01);
}

TEST(SensorFit, FindsOneSensorOfTwoRecordings) {
  SensorParameters truth = start();
  truth.contrast_on = 0.2;
  truth.contrast_off = 0.3;
  truth.mismatch_sigma = 0;
  SensorParameters truth_but_thresholds = truth;
  truth_but_thresholds.contrast_on = truth_but_thresholds.contrast_off = 0.25;
  const std::vector<RepeatedRecording> recordings{recording_of(truth, 1), recording_of(truth, 2)};
  SensorFitOptions options;
  options.fits_cutoff = options.fits_mismatch = false;
  const SensorFit fit = fit_sensor(recordings, truth_but_thresholds, options);
  EXPECT_NEAR(*fit.sensor.contrast_on / 0.2, 1, 0.05);
  EXPECT_NEAR(*fit.sensor.contrast_off / 0.3, 1, 0.05);
  EXPECT_EQ(fit.distances.size(), 2U);
  EXPECT_EQ(fit.folds.size(), 2 * StreamMoments::kFolds);
}

TEST(SensorFit, IntervalsHoldTheTruthOfAnotherRealisation) {
  // Recorded by pixels that see other sines than those that are simulated: now chance decides.
  SensorParameters truth = start();
  truth.contrast_on = 0.3;
  truth.contrast_off = 0.2;
  std::vector<RepeatedRecording> recordings{recording_of(truth, 1)};
  recordings[0].simulate = SinePixels{2};
  SensorFitOptions options;
  options.fits_cutoff = options.fits_mismatch = false;
  const SensorFit fit = fit_sensor(recordings, start(), options);
  int outside = 0;
  for (const FittedParameter& p : fit.parameters) {
    const double value = p.name == "contrast_on" ? 0.3 : p.name == "contrast_off" ? 0.2 : 1400;
    EXPECT_LT(p.low, p.value);
    EXPECT_GT(p.high, p.value);
    if (value < p.low || value > p.high) ++outside;
  }
  // Each is outside by chance in one of twenty cases.
  EXPECT_LE(outside, 1);
}

}  // namespace
}  // namespace saccade
