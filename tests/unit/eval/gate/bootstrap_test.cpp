#include "eval/gate/bootstrap.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "core/random.h"

namespace saccade {
namespace {

std::vector<double> normals(std::size_t count, double mean, double sigma, std::uint64_t stream) {
  const Random random(5);
  std::vector<double> values;
  for (std::size_t i = 0; i < count; ++i) values.push_back(mean + sigma * random.normal(stream, i));
  return values;
}

TEST(BootstrapMean, HoldsTheTrueMeanAsOftenAsItSays) {
  // Binomial: at 0.9 of 400 a deviation of 3.5 sigma is 21.
  ResampleOptions options;
  options.resamples = 1000;
  options.tail = 0.05;
  for (const std::size_t count : {6U, 20U}) {
    int inside = 0;
    for (std::uint64_t i = 0; i < 400; ++i) {
      const BootstrapMean found = bootstrap_mean(normals(count, 0.3, 0.04, i), options);
      inside += found.low <= 0.3 && 0.3 <= found.high ? 1 : 0;
    }
    EXPECT_NEAR(inside, 360, 21) << count << " values";
  }
}

TEST(BootstrapMean, FindsNoEffectWhereThereIsNoneAsRarelyAsPSays) {
  ResampleOptions options;
  options.resamples = 1000;
  int above = 0, below = 0;
  for (std::uint64_t i = 0; i < 1000; ++i) {
    const BootstrapMean found = bootstrap_mean(normals(6, 0, 0.04, i), options);
    above += found.p_above < 0.02 ? 1 : 0;
    below += found.p_below < 0.02 ? 1 : 0;
  }
  EXPECT_LT(above, 36);  // 20 expected, 3.5 sigma
  EXPECT_LT(below, 36);
}

TEST(BootstrapMean, IntervalAndEvidenceAgree) {
  ResampleOptions options;
  options.tail = 0.01;
  for (std::uint64_t i = 0; i < 40; ++i) {
    const BootstrapMean found = bootstrap_mean(normals(10, 0.03, 0.04, i), options);
    EXPECT_LE(found.low, found.mean);
    EXPECT_GE(found.high, found.mean);
    if (std::abs(found.p_above - 0.01) > 1e-3) {
      EXPECT_EQ(found.low > 0, found.p_above < 0.01) << i;
    }
  }
}

TEST(BootstrapMean, EqualValuesAreTheirOwnInterval) {
  const BootstrapMean none = bootstrap_mean(std::vector<double>(6, 0.0));
  EXPECT_EQ(none.p_above, 1);
  EXPECT_EQ(none.p_below, 1);
  const BootstrapMean some = bootstrap_mean(std::vector<double>(6, 0.05));
  EXPECT_EQ(some.low, some.high);
  EXPECT_LT(some.p_above, 2e-4);
  EXPECT_EQ(some.p_below, 1);
}

TEST(BootstrapMean, IsAFunctionOfValuesAndSeed) {
  const std::vector<double> values = normals(9, 0.1, 1, 3);
  const BootstrapMean first = bootstrap_mean(values), again = bootstrap_mean(values);
  EXPECT_EQ(first.low, again.low);
  EXPECT_EQ(first.p_above, again.p_above);
  ResampleOptions other;
  other.seed = 2;
  EXPECT_NE(bootstrap_mean(values, other).low, first.low);
}

TEST(BootstrapPairedRatio, HoldsTheRatio) {
  const std::vector<double> first = normals(20, 1, 0.03, 1), second = normals(20, 1.15, 0.03, 2);
  const BootstrapRatio found = bootstrap_paired_ratio(second, first);
  EXPECT_NEAR(found.ratio, 1.15, 0.03);
  EXPECT_LT(found.low, 1.15);
  EXPECT_GT(found.high, 1.15);
  EXPECT_GT(found.low, 1.1);
}

// A machine that runs at one of two speeds, a third apart, for ten runs or so: the medians of the
// sides lie at either, and pairs that a change of the speed falls into are off by a third.
TEST(BootstrapPairedRatio, HoldsTheRatioThroughChangesOfSpeed) {
  const Random random(7);
  int outside = 0, wide = 0;
  for (std::uint64_t trial = 0; trial < 50; ++trial) {
    std::vector<double> first, second;
    double speed = 1;
    std::uint64_t run = 0;
    const auto time = [&](double work) {
      if (random.uniform(trial, 2 * run) < 0.1) speed = speed > 1 ? 1 : 1.4;
      return work * speed * std::exp(0.03 * random.normal(trial, 2 * run++ + 1));
    };
    for (int i = 0; i < 20; ++i) {
      const bool second_first = i % 2 != 0;
      if (second_first) second.push_back(time(1.15));
      first.push_back(time(1));
      if (!second_first) second.push_back(time(1.15));
    }
    const BootstrapRatio found = bootstrap_paired_ratio(second, first);
    outside += found.low <= 1.15 && 1.15 <= found.high ? 0 : 1;
    wide += found.high - found.low > 0.15 ? 1 : 0;
  }
  EXPECT_LE(outside, 3);  // of intervals of 99 %: 0.5 expected
  EXPECT_LE(wide, 5);     // a third is 0.4
}

TEST(BootstrapPairedRatio, EqualTimesHaveTheRatioOne) {
  const std::vector<double> times(3, 2.0);
  const BootstrapRatio found = bootstrap_paired_ratio(times, times);
  EXPECT_EQ(found.low, 1);
  EXPECT_EQ(found.high, 1);
}

}  // namespace
}  // namespace saccade
