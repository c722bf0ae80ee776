#include "simulator/sensor/crossing.h"

#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

namespace saccade {
namespace {

struct Sample {
  double t_s = 0;
  double log_intensity = 0;
};

struct Fired {
  double t_s;
  int polarity;
};

/// Of the straight line from `a` to the signal at `t_s`.
double slope_at(const std::function<double(double)>& signal, double t_s, const Sample& a) {
  return std::abs(signal(t_s) - a.log_intensity) / (t_s - a.t_s);
}

/// Steps a pixel over a signal, `steps` per second.
struct Walk {
  std::vector<Fired> events;
  double widest_s = 0;
  int evaluations = 0;

  Walk(const std::function<double(double)>& signal, const Contrast& contrast, double duration_s,
       int steps, double tolerance_s) {
    EventPixel pixel(signal(0), contrast);
    const auto evaluate = [&](double t, const Sample&, const Sample&) {
      ++evaluations;
      return Sample{t, signal(t)};
    };
    const auto emit = [&](double t, int polarity) { events.push_back({t, polarity}); };
    Sample a{0, signal(0)};
    double slope = 0;
    for (int k = 1; k <= steps; ++k) {
      const double t = duration_s * k / steps;
      const Sample b{t, signal(t)};
      widest_s = std::max(widest_s, walk_step(pixel, contrast, a, b,
                                              {slope, slope_at(signal, t + duration_s / steps, b)},
                                              tolerance_s, {1.0, tolerance_s}, evaluate, emit));
      slope = slope_at(signal, t, a);
      a = b;
    }
  }
};

TEST(Crossing, RampFiresAtWholeMultiplesOfTheThreshold) {
  const double slope = 3.1;
  const Walk walk([&](double t) { return 0.7 + slope * t; }, {0.15, 0.2}, 1, 7, 1e-9);
  ASSERT_EQ(walk.events.size(), 20U);  // floor(3.1 / 0.15)
  for (std::size_t k = 0; k < walk.events.size(); ++k) {
    EXPECT_EQ(walk.events[k].polarity, 1);
    EXPECT_NEAR(walk.events[k].t_s, 0.15 * static_cast<double>(k + 1) / slope, 1e-12);
  }
}

TEST(Crossing, FallingRampUsesTheOffThreshold) {
  const Walk walk([](double t) { return -2.0 * t; }, {0.15, 0.3}, 1, 3, 1e-9);
  ASSERT_EQ(walk.events.size(), 6U);
  for (std::size_t k = 0; k < walk.events.size(); ++k) {
    EXPECT_EQ(walk.events[k].polarity, -1);
    EXPECT_NEAR(walk.events[k].t_s, 0.15 * static_cast<double>(k + 1), 1e-12);
  }
}

class CrossingOfSine : public ::testing::TestWithParam<int> {};

// L = A sin(2 pi f t) meets k C on its first rise at asin(k C / A) / (2 pi f); later times follow
// by symmetry. The steps are as coarse as an eighth of the period.
TEST_P(CrossingOfSine, IsExactWhateverTheSteps) {
  const double amplitude = 0.93;
  const double frequency = 10;
  const double contrast = 0.2;
  const double omega = 2 * std::numbers::pi * frequency;
  const Walk walk([&](double t) { return amplitude * std::sin(omega * t); }, {contrast, contrast},
                  1, GetParam(), 1e-8);
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

INSTANTIATE_TEST_SUITE_P(Steps, CrossingOfSine, ::testing::Values(80, 97, 100, 131, 1000, 10000));

TEST(Crossing, ExcursionWithinAStepIsFound) {
  // A parabola that rises above the threshold by a hair in the middle of the third of five steps.
  const auto signal = [](double t) { return 0.1501 - 4 * (t - 0.5) * (t - 0.5); };
  const Contrast contrast{0.15 - signal(0), 10};
  const Walk walk(signal, contrast, 1, 5, 1e-7);
  ASSERT_EQ(walk.events.size(), 1U);
  EXPECT_NEAR(walk.events[0].t_s, 0.5 - std::sqrt(1e-4 / 4), 1e-7);
}

TEST(Crossing, ThresholdsMetByAJumpShareItsTime) {
  const double jump_s = 0.123456789;
  const Walk walk([&](double t) { return t < jump_s ? 0.05 * t : 0.5; }, {0.15, 0.15}, 1, 9, 1e-6);
  ASSERT_EQ(walk.events.size(), 3U);
  for (const Fired& fired : walk.events) {
    EXPECT_NEAR(fired.t_s, jump_s, 1e-6);
    EXPECT_EQ(fired.t_s, walk.events[0].t_s);
  }
  EXPECT_LE(walk.widest_s, 1e-6);
  EXPECT_LE(walk.evaluations, 40);
}

// The signal rises through its threshold and is then thrown far below, all within one step.
TEST(Crossing, RiseHiddenByALaterFallIsFound) {
  const auto signal = [](double t) { return t < 0.5 ? 0.4 * t : -0.4; };
  const Walk walk(signal, {0.15, 0.15}, 1, 1, 1e-7);
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
  const Walk walk([&](double t) { return static_cast<int>(t) % 2 == 0 ? 0.3 : high; },
                  {contrast, contrast}, 1000, 10000, 1e-6);
  EXPECT_EQ(walk.events.size(), 1000U * 3);
}

TEST(Crossing, SmoothSignalTakesFewEvaluations) {
  const Walk walk([](double t) { return std::exp(t); }, {0.1, 0.1}, 1, 10, 1e-6);
  ASSERT_EQ(walk.events.size(), 17U);
  EXPECT_LE(walk.evaluations, 17 * 6);
}

}  // namespace
}  // namespace saccade
