#include "simulator/sensor/noise/photoreceptor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/random.h"
#include "tests/unit/simulator/sensor/noise/log_eps.h"

namespace saccade {
namespace {

using testing::kLogEps;

/// Random pieces whose states, inputs and rates reach from slow to fast.
class RandomPieces {
 public:
  explicit RandomPieces(std::uint64_t seed) : random_(seed) {}

  double uniform(double low, double high) {
    return low + (high - low) * random_.uniform(0, draw_++);
  }
  FilterState state() { return {uniform(-1, 1), uniform(-1, 1)}; }
  LinearPiece input(double duration_s) {
    const double t0_s = uniform(0, 100);
    return {t0_s, t0_s + duration_s, uniform(-1, 1), uniform(-1, 1)};
  }
  /// rate * duration between 10^low and 10^high.
  double rate(const LinearPiece& input, double low, double high) {
    return std::pow(10, uniform(low, high)) / (input.t1_s - input.t0_s);
  }

 private:
  Random random_;
  std::uint64_t draw_ = 0;
};

/// Classical Runge-Kutta over the whole piece.
FilterState runge_kutta(FilterState state, const LinearPiece& input, double rate, int order,
                        int steps) {
  const double duration_s = input.t1_s - input.t0_s;
  const auto slope = [&](double share, const FilterState& s) {
    const double x = input.start + share * (input.end - input.start);
    const double first = rate * (x - s.first);
    return FilterState{first, order == 1 ? rate * (x - s.output) : rate * (s.first - s.output)};
  };
  const auto moved = [](const FilterState& s, const FilterState& by, double h) {
    return FilterState{s.first + h * by.first, s.output + h * by.output};
  };
  const double h = duration_s / steps;
  for (int i = 0; i < steps; ++i) {
    const auto share = [&](double part) { return (i + part) / steps; };
    const FilterState k1 = slope(share(0), state);
    const FilterState k2 = slope(share(0.5), moved(state, k1, h / 2));
    const FilterState k3 = slope(share(0.5), moved(state, k2, h / 2));
    const FilterState k4 = slope(share(1), moved(state, k3, h));
    for (const auto& [k, weight] : {std::pair{k1, 1.0}, {k2, 2.0}, {k3, 2.0}, {k4, 1.0}})
      state = moved(state, k, h * weight / 6);
  }
  return state;
}

TEST(ExponentialRise, IsExactToRounding) {
  EXPECT_EQ(exponential_rise(0), 0);
  for (double a = 1e-12; a < 1e6; a *= 1.01)
    EXPECT_NEAR(exponential_rise(a), -std::expm1(-a), 4e-16 * -std::expm1(-a)) << a;
}

TEST(FilteredPiece, AgreesWithRungeKutta) {
  RandomPieces pieces(1);
  for (int trial = 0; trial < 200; ++trial) {
    for (const int order : {1, 2}) {
      const LinearPiece input = pieces.input(0.01);
      const double rate = pieces.rate(input, -3, 1);
      FilterState state = pieces.state();
      if (order == 1) state.first = state.output;
      const FilterState exact = runge_kutta(state, input, rate, order, 2000);
      const FilterState end = FilteredPiece(state, input, rate, order).end_state();
      ASSERT_NEAR(end.output, exact.output, 1e-11) << order;
      ASSERT_NEAR(end.first, exact.first, 1e-11) << order;
    }
  }
}

TEST(FilteredPiece, CutIntoPartsGivesTheSameAtEveryRate) {
  RandomPieces pieces(2);
  constexpr int kParts = 100;
  for (int trial = 0; trial < 500; ++trial) {
    for (const int order : {1, 2}) {
      const LinearPiece input{0, 0.02, pieces.uniform(-5, 5), pieces.uniform(-5, 5)};
      const double rate = pieces.rate(input, -9, 6);
      const FilterState state = pieces.state();
      FilterState part = state;
      const auto at = [&](int i) { return input.start + (input.end - input.start) * i / kParts; };
      for (int i = 0; i < kParts; ++i)
        part = FilteredPiece(part, {0.02 * i / kParts, 0.02 * (i + 1) / kParts, at(i), at(i + 1)},
                             rate, order)
                   .end_state();
      const FilterState whole = FilteredPiece(state, input, rate, order).end_state();
      ASSERT_NEAR(whole.output, part.output, 1e-12) << order << " " << rate;
      ASSERT_NEAR(whole.first, part.first, 1e-12) << order << " " << rate;
    }
  }
}

TEST(FilteredPiece, WithoutLengthKeepsTheStateAndAJumpOnlyEnters) {
  const FilteredPiece none({0.3, 0.2}, {1, 1, 0, 5}, 1000, 2);
  EXPECT_EQ(none.end_state().first, 0.3);
  EXPECT_EQ(none.end_state().output, 0.2);
  EXPECT_EQ(none.extrema().count, 0);
  EXPECT_FALSE(none.first_crossing(0, 1, 1, 1e-9));
}

TEST(FilteredPiece, LatencyOfAStep) {
  const double tau_s = 1.0 / 300;
  for (const double step : {0.2, 0.5, 3.0, -0.5}) {
    const LinearPiece input{2, 3, step, step};
    const double contrast = 0.15;
    const auto one = FilteredPiece({0, 0}, input, 1 / tau_s, 1);
    const auto crossing = one.first_crossing(-contrast, contrast, 2, 1e-9);
    ASSERT_TRUE(crossing);
    EXPECT_EQ(crossing->polarity, step > 0 ? 1 : -1);
    EXPECT_NEAR(crossing->t_s - 2, -tau_s * std::log(1 - contrast / std::abs(step)), 1e-9);
    const auto two = FilteredPiece({0, 0}, input, 1 / tau_s, 2);
    const auto later = two.first_crossing(-contrast, contrast, 2, 1e-9);
    ASSERT_TRUE(later);
    const double a = (later->t_s - 2) / tau_s;
    EXPECT_NEAR(1 - (1 + a) * std::exp(-a), contrast / std::abs(step), 1e-6);
    EXPECT_GT(later->t_s, crossing->t_s);
  }
  EXPECT_FALSE(
      FilteredPiece({0, 0}, {0, 100, 0.1, 0.1}, 1 / tau_s, 1).first_crossing(-0.15, 0.15, 0, 1e-9));
}

TEST(FilteredPiece, TurnsAreItsExtrema) {
  RandomPieces pieces(3);
  int seen[3] = {0, 0, 0};
  for (int trial = 0; trial < 3000; ++trial) {
    for (const int order : {1, 2}) {
      LinearPiece input = pieces.input(0.01);
      if (trial % 3 == 0) input.end = input.start;
      const FilteredPiece piece(pieces.state(), input, pieces.rate(input, -1, 3), order);
      const FilteredPiece::Extrema turns = piece.extrema();
      ASSERT_LE(turns.count, order);
      ++seen[turns.count];
      std::vector<double> knots = {input.t0_s};
      knots.insert(knots.end(), turns.t_s.begin(), turns.t_s.begin() + turns.count);
      knots.push_back(input.t1_s);
      for (std::size_t k = 0; k + 1 < knots.size(); ++k) {
        ASSERT_LE(knots[k], knots[k + 1]);
        const double low = std::min(piece.value(knots[k]), piece.value(knots[k + 1]));
        const double high = std::max(piece.value(knots[k]), piece.value(knots[k + 1]));
        for (int i = 1; i < 50; ++i) {
          const double y = piece.value(knots[k] + (knots[k + 1] - knots[k]) * i / 50);
          ASSERT_GE(y, low - 1e-12);
          ASSERT_LE(y, high + 1e-12);
        }
      }
    }
  }
  EXPECT_GT(seen[1], 500);
  EXPECT_GT(seen[2], 100);
}

TEST(FilteredPiece, StaysWithinItsReach) {
  RandomPieces pieces(6);
  for (int trial = 0; trial < 4000; ++trial) {
    const int order = 1 + trial % 2;
    const LinearPiece input = pieces.input(0.01);
    const FilteredPiece piece(pieces.state(), input, pieces.rate(input, -9, 6), order);
    const auto [reach_low, reach_high] = piece.bounds();
    for (int i = 0; i <= 100; ++i) {
      const double y = piece.value(input.t0_s + (input.t1_s - input.t0_s) * i / 100);
      ASSERT_GE(y, reach_low - 1e-12);
      ASSERT_LE(y, reach_high + 1e-12);
    }
  }
  // Narrow where there is little time.
  const auto [brief_low, brief_high] = FilteredPiece({0, 0}, {0, 0.01, 1, 1}, 1, 2).bounds();
  EXPECT_EQ(brief_low, 0);
  EXPECT_NEAR(brief_high, -std::expm1(-0.01), 1e-15);
}

TEST(FilteredPiece, FirstCrossingIsTheFirst) {
  RandomPieces pieces(4);
  constexpr double kTolerance_s = 1e-10;
  constexpr int kLooks = 500;
  int found = 0;
  for (int trial = 0; trial < 4000; ++trial) {
    const int order = 1 + trial % 2;
    const LinearPiece input = pieces.input(0.01);
    const FilterState state = pieces.state();
    FilteredPiece piece(state, input, pieces.rate(input, -9, 6), order);
    if (trial % 4 < 2) piece = piece.drifting(pieces.uniform(-10, 10));
    const double lower = state.output - pieces.uniform(0.01, 0.5);
    const double upper = state.output + pieces.uniform(0.01, 0.5);
    const auto crossing = piece.first_crossing(lower, upper, input.t0_s, kTolerance_s);
    const double end_s = crossing ? crossing->t_s - 2 * kTolerance_s : input.t1_s;
    for (int i = 0; i <= kLooks && end_s > input.t0_s; ++i) {
      const double y = piece.value(input.t0_s + (end_s - input.t0_s) * i / kLooks);
      ASSERT_LT(y, upper + 1e-12);
      ASSERT_GT(y, lower - 1e-12);
    }
    if (!crossing) continue;
    ++found;
    const double y = piece.value(crossing->t_s);
    ASSERT_GE(crossing->polarity * (y - (crossing->polarity > 0 ? upper : lower)), -1e-6);
  }
  EXPECT_GT(found, 1000);
}

TEST(FilteredPiece, FindsAnExcursionThatReturns) {
  // The first stage is still high and lifts the output above the band for a moment.
  const LinearPiece input{0, 1, 0, 0};
  const FilteredPiece piece({1, 0}, input, 100, 2);
  const double peak = std::exp(-1.0);
  ASSERT_LT(piece.value(1), 1e-3);
  const auto crossing = piece.first_crossing(-1, 0.999 * peak, 0, 1e-9);
  ASSERT_TRUE(crossing);
  EXPECT_LT(crossing->t_s, 0.01);
  EXPECT_NEAR(piece.value(crossing->t_s), 0.999 * peak, 1e-6);
  EXPECT_FALSE(piece.first_crossing(-1, 1.001 * peak, 0, 1e-9));
  // A piece so long that its end has forgotten everything.
  EXPECT_TRUE(FilteredPiece({1, 0}, {0, 1e4, 0, 0}, 100, 2).first_crossing(-1, 0.3, 0, 1e-9));
  EXPECT_TRUE(FilteredPiece({1, 0}, {0, 1e4, 0, 1e-9}, 100, 2).first_crossing(-1, 0.3, 0, 1e-9));
}

TEST(FilteredPiece, ReportsAStateOutsideTheBandAtOnce) {
  const FilteredPiece piece({0, 0}, {5, 6, 0, 0}, 100, 2);
  const auto crossing = piece.first_crossing(0.1, 0.3, 5.25, 1e-9);
  ASSERT_TRUE(crossing);
  EXPECT_EQ(crossing->t_s, 5.25);
  EXPECT_EQ(crossing->polarity, -1);
}

TEST(FilteredPiece, DriftAddsALine) {
  RandomPieces pieces(5);
  for (int trial = 0; trial < 500; ++trial) {
    const int order = 1 + trial % 2;
    const LinearPiece input = pieces.input(0.01);
    const FilteredPiece piece(pieces.state(), input, pieces.rate(input, -2, 3), order);
    const double slope = pieces.uniform(-10, 10);
    const FilteredPiece drifting = piece.drifting(slope);
    for (int i = 0; i <= 10; ++i) {
      const double t = input.t0_s + 0.001 * i;
      ASSERT_NEAR(drifting.value(t), piece.value(t) + slope * (t - input.t0_s), 1e-12);
    }
  }
}

TEST(PhotoreceptorFilter, CutoffGrowsWithTheRadianceUpToItsLimit) {
  BandwidthOptions options;
  options.cutoff_hz = 300;
  options.dark_radiance = 0.1;
  options.max_cutoff_hz = 500;
  const PhotoreceptorFilter filter(options, kLogEps);
  const auto at = [&](double radiance) { return filter.cutoff_hz(std::log(radiance + kLogEps)); };
  EXPECT_NEAR(at(1), 300, 1e-9);
  EXPECT_NEAR(at(0), 300 * 0.1 / 1.1, 1e-9);
  EXPECT_NEAR(at(0.5), 300 * 0.6 / 1.1, 1e-9);
  EXPECT_NEAR(at(100), 500, 1e-9);
  EXPECT_EQ(filter.cutoff_hz(-100), at(0));
}

TEST(PhotoreceptorFilter, ForgetsItsStateWithinItsMemory) {
  BandwidthOptions options;
  options.cutoff_hz = 300;
  const double dark = 0.02;
  const double log_dark = std::log(kLogEps + dark);
  for (const int order : {1, 2}) {
    options.order = order;
    const PhotoreceptorFilter filter(options, kLogEps);
    const double memory_s = filter.memory_s(dark);
    EXPECT_NEAR(memory_s * 2 * std::numbers::pi * filter.cutoff_hz(log_dark), 10, 1e-9);
    const LinearPiece input{0, memory_s, log_dark, log_dark};
    const double a = filter.piece({1, 1}, input).end_state().output;
    const double b = filter.piece({0, 0}, input).end_state().output;
    EXPECT_LT(a - b, 1.0 / 2000) << order;
  }
}

TEST(PhotoreceptorFilter, AttenuatesASineAsItsPolesDo) {
  BandwidthOptions options;
  options.cutoff_hz = 100;
  options.dark_radiance = 1e6;  // the same cutoff at every radiance
  for (const int order : {1, 2}) {
    options.order = order;
    const PhotoreceptorFilter filter(options, kLogEps);
    FilterState state = PhotoreceptorFilter::settled(0);
    const auto signal = [](double t) { return 0.1 * std::sin(2 * std::numbers::pi * 100 * t); };
    double highest = 0;
    constexpr double kStep_s = 1e-5;
    for (int i = 0; i < 10000; ++i) {
      const double t = kStep_s * i;
      const FilteredPiece piece =
          filter.piece(state, {t, t + kStep_s, signal(t), signal(t + kStep_s)});
      state = piece.end_state();
      if (i > 8000) highest = std::max(highest, state.output);
    }
    EXPECT_NEAR(highest, 0.1 * std::pow(0.5, 0.5 * order), 1e-5) << order;
  }
}

}  // namespace
}  // namespace saccade
