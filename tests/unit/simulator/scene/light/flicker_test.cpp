#include "simulator/scene/light/flicker.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "core/config/config.h"
#include "core/random.h"
#include "tests/support/error_of.h"

namespace saccade {
namespace {

using ::testing::AllOf;
using testing::error_of;
using ::testing::HasSubstr;

constexpr double kPi = std::numbers::pi;

std::vector<FlickerOptions> many() {
  return {{100, Waveform::kSine, 0.7, 0.5, 0},    {120, Waveform::kSine, 1, 0.5, 77},
          {100, Waveform::kMains, 0.4, 0.5, 0},   {100, Waveform::kMains, 1, 0.5, -123},
          {1000, Waveform::kSquare, 1, 0.25, 30}, {333, Waveform::kSquare, 0.3, 0.9, -300}};
}

TEST(Flicker, HasItsWaveforms) {
  const Flicker sine({100, Waveform::kSine, 0.5, 0.5, 90});
  EXPECT_NEAR(sine.at(0), 1.5, 1e-12);
  EXPECT_NEAR(sine.at(0.0025), 1, 1e-12);
  EXPECT_NEAR(sine.at(0.005), 0.5, 1e-12);
  const Flicker mains({100, Waveform::kMains, 0.5, 0.5, 0});
  EXPECT_NEAR(mains.at(0), 0.5, 1e-12);
  EXPECT_NEAR(mains.at(0.005), 0.5 + 0.25 * kPi, 1e-12);
  EXPECT_NEAR(mains.at(0.01 + 0.0025), 0.5 + 0.25 * kPi * std::sqrt(0.5), 1e-12);
  const Flicker square({1000, Waveform::kSquare, 1, 0.25, 0});
  EXPECT_EQ(square.at(0.0001), 4);
  EXPECT_EQ(square.at(0.0003), 0);
  EXPECT_EQ(square.at(0.0011), 4);
}

TEST(Flicker, MeansAreIntegrals) {
  for (const FlickerOptions& options : many()) {
    const Flicker flicker(options);
    EXPECT_NEAR(flicker.mean(0.0123, flicker.period_s()), 1, 1e-9);
    EXPECT_NEAR(flicker.mean(0.0123, 3 * flicker.period_s()), 1, 1e-9);
    EXPECT_EQ(flicker.mean(0.0123, 0), flicker.at(0.0123));
    constexpr int kParts = 100'000;
    constexpr double kSpan_s = 0.0047;
    double sum = 0;
    for (int k = 0; k < kParts; ++k) sum += flicker.at(0.02 + kSpan_s * ((k + 0.5) / kParts - 0.5));
    EXPECT_NEAR(flicker.mean(0.02, kSpan_s), sum / kParts, 2e-4) << options.frequency_hz;
  }
}

TEST(Flicker, RangesHoldWhatIsBetweenAndNotMuchMore) {
  const Random random(3);
  for (const FlickerOptions& options : many()) {
    const Flicker flicker(options);
    for (std::uint64_t n = 0; n < 300; ++n) {
      const double from = 0.1 * random.uniform(n, 0);
      const double to = from + std::pow(10, -5 + 4 * random.uniform(n, 1));
      const LightRange range = flicker.range(from, to);
      double low = std::numeric_limits<double>::infinity(), high = -low;
      constexpr int kParts = 2000;
      for (int k = 0; k <= kParts; ++k) {
        const double value = flicker.at(from + (to - from) * k / kParts);
        low = std::min(low, value);
        high = std::max(high, value);
      }
      EXPECT_LE(range.low, low + 1e-12);
      EXPECT_GE(range.high, high - 1e-12);
      // Between the samples: a part of the range that an interval of many periods has at most.
      EXPECT_NEAR(range.low, low, 0.1 * options.depth + 1e-9);
      EXPECT_NEAR(range.high, high, 0.1 * options.depth + 1e-9);
      const double chord = (flicker.at(to) - flicker.at(from)) / (to - from);
      EXPECT_LE(range.rate_low, chord + 1e-6);
      EXPECT_GE(range.rate_high, chord - 1e-6);
    }
  }
}

TEST(Flicker, BetweenItsBreaksItIsMonotone) {
  for (const FlickerOptions& options : many()) {
    const Flicker flicker(options);
    constexpr double kAround_s = 1e-7;
    std::vector<double> breaks{0.0017};
    flicker.find_breaks(0.0017, 0.0517, kAround_s, breaks);
    breaks.push_back(0.0517);
    EXPECT_NEAR(static_cast<double>(breaks.size()),
                0.05 * options.frequency_hz * (options.waveform == Waveform::kSquare ? 4 : 2), 5);
    ASSERT_TRUE(std::ranges::is_sorted(breaks));
    for (std::size_t k = 1; k < breaks.size(); ++k) {
      const LightRange range = flicker.range(breaks[k - 1], breaks[k]);
      if (std::isinf(range.rate_high)) {
        EXPECT_NEAR(breaks[k] - breaks[k - 1], 2 * kAround_s, 1e-9);
        EXPECT_NE(flicker.at(breaks[k - 1]), flicker.at(breaks[k]));
        continue;
      }
      const double slack = 1e-6 * std::max(std::abs(range.rate_low), std::abs(range.rate_high));
      EXPECT_TRUE(range.rate_low >= -slack || range.rate_high <= slack) << breaks[k];
    }
  }
}

TEST(Flicker, JumpsAreFoundOneAfterTheOther) {
  const Flicker square({1000, Waveform::kSquare, 1, 0.25, 0});
  EXPECT_NEAR(*square.first_jump(0.0001, 1), 0.00025, 1e-12);
  EXPECT_NEAR(*square.first_jump(0.0003, 1), 0.001, 1e-12);
  EXPECT_FALSE(square.first_jump(0.0003, 0.0009));
  const std::vector<Flicker> both{square, Flicker({500, Waveform::kSquare, 1, 0.45, 0})};
  EXPECT_NEAR(*first_jump(both, 0.0003, 1), 0.0009, 1e-12);
  EXPECT_FALSE(Flicker({100, Waveform::kMains, 1, 0.5, 0}).first_jump(0, 1));
  EXPECT_EQ(shortest_period_s(both), 0.001);
  EXPECT_EQ(shortest_period_s({}), std::numeric_limits<double>::infinity());
}

TEST(Flicker, RangesOfProductsHoldAllProducts) {
  const LightRange falling{0, 2, -3, -1};
  const LightRange turning{1, 4, -2, 5};
  const LightRange range = falling.times(turning);
  EXPECT_EQ(range.low, 0);
  EXPECT_EQ(range.high, 8);
  EXPECT_EQ(range.rate_low, -3 * 4 - 2 * 2);
  EXPECT_EQ(range.rate_high, -1 * 1 + 5 * 2);
  constexpr double kJump = std::numeric_limits<double>::infinity();
  const LightRange jump{0, 0, -kJump, kJump};
  EXPECT_EQ(LightRange({0, 0, 0, 0}).times(jump).rate_high, kJump);
}

FlickerOptions read(const std::string& yaml) {
  return config::read<FlickerOptions>(config::parse(yaml, "light.yaml", "/data"));
}

TEST(FlickerOptions, AreReadAndPrinted) {
  const FlickerOptions options =
      read("{waveform: square, frequency_hz: 240, depth: 0.5, duty: 0.1, phase_deg: 45}");
  EXPECT_EQ(options, FlickerOptions({240, Waveform::kSquare, 0.5, 0.1, 45}));
  EXPECT_EQ(read(config::print(options)), options);
}

TEST(FlickerOptions, MalformedOnesAreErrorsWithTheirPlace) {
  const auto error = [](const std::string& yaml) {
    return error_of([&] { static_cast<void>(read(yaml)); });
  };
  EXPECT_THAT(error("depth: 1.5"), AllOf(HasSubstr("light.yaml:1"), HasSubstr("depth")));
  EXPECT_THAT(error("frequency_hz: 0"), HasSubstr("frequency_hz"));
  EXPECT_THAT(error("frequency_hz: 1e6"), HasSubstr("frequency_hz"));
  EXPECT_THAT(error("{waveform: square, duty: 1}"), HasSubstr("duty"));
  EXPECT_THAT(error("duty: 0.5"), AllOf(HasSubstr("duty"), HasSubstr("waveform: square")));
  EXPECT_THAT(error("waveform: triangle"), AllOf(HasSubstr("triangle"), HasSubstr("mains")));
  EXPECT_THAT(error("frequenzy_hz: 50"), HasSubstr("frequency_hz"));
}

}  // namespace
}  // namespace saccade
