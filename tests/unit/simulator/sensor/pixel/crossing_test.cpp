#include "simulator/sensor/pixel/crossing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "simulator/sensor/pixel/pixel_sensor.h"

namespace saccade {
namespace {

constexpr double kEps = 1e-3;

struct Sample {
  double t_s = 0;
  double log_intensity = 0;
};

/// A log intensity in closed form. Its bounds over a stretch come from a grid; it counts as
/// monotone between the `breaks`, which are its extrema and jumps.
struct ClosedForm {
  using Sample = saccade::Sample;

  std::function<double(double)> log_intensity;
  std::vector<double> breaks;
  double tolerance = 1e-9;
  mutable int evaluations = 0;

  [[nodiscard]] double tolerance_s() const { return tolerance; }
  [[nodiscard]] Sample sample(double t_s) const { return {t_s, log_intensity(t_s)}; }
  [[nodiscard]] Sample at(double t_s, const Sample&, const Sample&) const {
    ++evaluations;
    return sample(t_s);
  }
  [[nodiscard]] Sample divide(const Sample& lo, const Sample& hi, int) const {
    return at(0.5 * (lo.t_s + hi.t_s), lo, hi);
  }
  [[nodiscard]] RadianceRange range(const Sample& lo, const Sample& hi) const {
    for (const double at_s : breaks)
      if (at_s > lo.t_s && at_s <= hi.t_s) return {};
    const double a = std::exp(lo.log_intensity) - kEps;
    const double b = std::exp(hi.log_intensity) - kEps;
    const double rate = (b - a) / (hi.t_s - lo.t_s);
    return {std::min(a, b), std::max(a, b), rate, rate};
  }
};

struct Fired {
  double t_s;
  int polarity;
};

/// Steps a pixel over a signal in `steps` equal stretches.
struct Walk {
  std::vector<Fired> events;
  double widest_s = 0;

  Walk(const ClosedForm& signal, const Contrast& contrast, double duration_s, int steps) {
    const PixelTraits traits{0, 0, contrast, 0};
    PixelState state{EventPixel(signal.sample(0).log_intensity, contrast), 0};
    Thresholds thresholds(state.reference.band(), 0, kEps);
    const auto emit = [&](double t, int polarity, EventOrigin origin, double) {
      EXPECT_EQ(origin, EventOrigin::kSignal);
      events.push_back({t, polarity});
    };
    PixelSensor sensor(signal, traits, kEps, state, thresholds, emit);
    for (int k = 0; k < steps; ++k)
      widest_s = std::max(widest_s, sensor.sense(signal.sample(duration_s * k / steps),
                                                 signal.sample(duration_s * (k + 1) / steps)));
  }
};

TEST(Crossing, RampFiresAtWholeMultiplesOfTheThreshold) {
  const double slope = 3.1;
  const ClosedForm ramp{[&](double t) { return 0.7 + slope * t; }, {}, 1e-10};
  for (const int steps : {1, 7, 1000}) {
    const Walk walk(ramp, {0.15, 0.2}, 1, steps);
    ASSERT_EQ(walk.events.size(), 20U);  // floor(3.1 / 0.15)
    for (std::size_t k = 0; k < walk.events.size(); ++k) {
      EXPECT_EQ(walk.events[k].polarity, 1);
      EXPECT_NEAR(walk.events[k].t_s, 0.15 * static_cast<double>(k + 1) / slope, 1e-12);
    }
  }
}

TEST(Crossing, FallingRampUsesTheOffThreshold) {
  const ClosedForm ramp{[](double t) { return -2.0 * t; }, {}, 1e-10};
  const Walk walk(ramp, {0.15, 0.3}, 1, 3);
  ASSERT_EQ(walk.events.size(), 6U);
  for (std::size_t k = 0; k < walk.events.size(); ++k) {
    EXPECT_EQ(walk.events[k].polarity, -1);
    EXPECT_NEAR(walk.events[k].t_s, 0.3 * static_cast<double>(k + 1) / 2, 1e-12);
  }
}

class CrossingOfSine : public ::testing::TestWithParam<int> {};

// L = A sin(2 pi f t) intersects k C on its first rise at asin(k C / A) / (2 pi f); later times follow
// by symmetry.
TEST_P(CrossingOfSine, IsExactWhateverTheSteps) {
  const double amplitude = 0.93;
  const double frequency = 10;
  const double contrast = 0.2;
  const double omega = 2 * std::numbers::pi * frequency;
  ClosedForm sine{[&](double t) { return amplitude * std::sin(omega * t); }, {}, 1e-8};
  for (int k = 0; k < 20; ++k) sine.breaks.push_back((k + 0.5) / (2 * frequency));
  const Walk walk(sine, {contrast, contrast}, 1, GetParam());
  std::vector<Fired> expected;
  for (int k = 1; k <= 4; ++k) expected.push_back({std::asin(k * contrast / amplitude) / omega, 1});
  for (int half = 0; half < 20; ++half) {
    // From the extremum after half + 1/2 half periods to the next one; the last is cut at t = 1.
    const int polarity = half % 2 == 0 ? -1 : 1;
    for (int k = 3; k >= -4; --k) {
      const double t =
          (half + 1 - std::asin(k * contrast / amplitude) / std::numbers::pi) / 2 / frequency;
      if (t < 1 - 1e-9) expected.push_back({t, polarity});
    }
  }
  ASSERT_EQ(walk.events.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(walk.events[i].polarity, expected[i].polarity) << i;
    EXPECT_NEAR(walk.events[i].t_s, expected[i].t_s, 1e-8) << i;
  }
  EXPECT_LE(walk.widest_s, 1e-8);
}

INSTANTIATE_TEST_SUITE_P(Steps, CrossingOfSine,
                         ::testing::Values(1, 7, 80, 97, 100, 131, 1000, 10000));

TEST(Crossing, ExcursionWithinAStepIsFound) {
  // A parabola that rises above the threshold by a hair in the middle of the third of five steps.
  const ClosedForm parabola{
      [](double t) { return 0.1501 - 4 * (t - 0.5) * (t - 0.5); }, {0.5}, 1e-7};
  const Contrast contrast{0.15 - parabola.log_intensity(0), 10};
  const Walk walk(parabola, contrast, 1, 5);
  ASSERT_EQ(walk.events.size(), 1U);
  EXPECT_NEAR(walk.events[0].t_s, 0.5 - std::sqrt(1e-4 / 4), 1e-7);
}

TEST(Crossing, ThresholdsMetByAJumpShareItsTime) {
  const double jump_s = 0.123456789;
  const ClosedForm jump{[&](double t) { return t < jump_s ? 0.05 * t : 0.5; }, {jump_s}, 1e-6};
  const Walk walk(jump, {0.15, 0.15}, 1, 9);
  ASSERT_EQ(walk.events.size(), 3U);
  for (const Fired& fired : walk.events) {
    EXPECT_NEAR(fired.t_s, jump_s, 1e-6);
    EXPECT_EQ(fired.t_s, walk.events[0].t_s);
  }
  EXPECT_LE(walk.widest_s, 1e-6);
  EXPECT_LE(jump.evaluations, 40);
}

// The signal rises through its threshold and is then thrown far below, all within one step.
TEST(Crossing, RiseHiddenByALaterFallIsFound) {
  const ClosedForm signal{[](double t) { return t < 0.5 ? 0.4 * t : -0.4; }, {0.5}, 1e-7};
  const Walk walk(signal, {0.15, 0.15}, 1, 1);
  ASSERT_EQ(walk.events.size(), 4U);  // up at 0.15, down at 0, -0.15, -0.3
  EXPECT_EQ(walk.events[0].polarity, 1);
  EXPECT_NEAR(walk.events[0].t_s, 0.375, 1e-7);
  for (std::size_t k = 1; k < 4; ++k) {
    EXPECT_EQ(walk.events[k].polarity, -1);
    EXPECT_NEAR(walk.events[k].t_s, 0.5, 1e-7);
  }
}

TEST(Crossing, FlatLevelReachedAgainMeetsTheSameThresholds) {
  // Two flat levels exactly three thresholds apart: each jump fires three events, for ever.
  const double contrast = 0.1;
  const double high = 0.3 + 3 * contrast;
  ClosedForm levels{[&](double t) { return static_cast<int>(t) % 2 == 0 ? 0.3 : high; }, {}, 1e-6};
  for (int k = 1; k <= 1000; ++k) levels.breaks.push_back(k);
  const Walk walk(levels, {contrast, contrast}, 1000, 10007);
  EXPECT_EQ(walk.events.size(), 1000U * 3);
}

TEST(Crossing, SmoothSignalTakesFewEvaluations) {
  const ClosedForm rise{[](double t) { return std::exp(t); }, {}, 1e-6};
  const Walk walk(rise, {0.1, 0.1}, 1, 10);
  ASSERT_EQ(walk.events.size(), 17U);
  EXPECT_LE(rise.evaluations, 17 * 6);
}

TEST(Thresholds, CertifyNothingThatIsAtAThreshold) {
  const Thresholds thresholds({-0.2, 0.3}, 0, kEps);
  const double upper = std::exp(0.3) - kEps;
  const double lower = std::exp(-0.2) - kEps;
  const auto certify = [&](double low, double high) {
    return thresholds.certify({low, high, 0, 0}, 1);
  };
  EXPECT_TRUE(certify(lower * (1 + 1e-9), upper * (1 - 1e-9)));
  EXPECT_FALSE(certify(lower, 1));
  EXPECT_FALSE(certify(1, upper));
}

TEST(Thresholds, DriftBringsTheUpperOneNearer) {
  const Thresholds thresholds({-0.2, 0.3}, 0.1, kEps);
  const RadianceRange range{1, std::exp(0.25) - kEps, 0, 0};
  EXPECT_TRUE(thresholds.certify(range, 0.4));
  EXPECT_FALSE(thresholds.certify(range, 0.5));
  EXPECT_DOUBLE_EQ(thresholds.signal(Sample{2, 0.7}), 0.9);
}

}  // namespace
}  // namespace saccade
