#include "core/random.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

namespace saccade {
namespace {

using Bits = std::array<std::uint32_t, 4>;

TEST(Random, MatchesThePublishedVectorOfPhilox) {
  EXPECT_EQ(Random(0).bits(0, 0), (Bits{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  EXPECT_EQ(Random(~0ULL).bits(~0ULL, ~0ULL),
            (Bits{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
}

TEST(Random, DependsOnIdentityNotOnOrder) {
  const Random random(42);
  std::vector<double> forward;
  std::vector<double> backward(100);
  for (std::uint64_t i = 0; i < 100; ++i) forward.push_back(random.uniform(5, i));
  for (std::uint64_t i = 100; i-- > 0;) backward[i] = random.uniform(5, i);
  EXPECT_EQ(forward, backward);
}

TEST(Random, SeedStreamAndIndexEachMatter) {
  const Bits bits = Random(1).bits(2, 3);
  EXPECT_NE(bits, Random(2).bits(2, 3));
  EXPECT_NE(bits, Random(1).bits(3, 3));
  EXPECT_NE(bits, Random(1).bits(2, 4));
  EXPECT_NE(Random(1).bits(2, 3), Random(1).bits(3, 2));
}

/// Chi-square of `counts` against equal shares.
double chi_square(const std::vector<int>& counts, double expected) {
  double sum = 0;
  for (const int count : counts) sum += (count - expected) * (count - expected) / expected;
  return sum;
}

TEST(Random, UniformFillsItsRangeEvenly) {
  constexpr int kBins = 100;
  constexpr int kDraws = 100'000;
  std::vector<int> counts(kBins);
  for (std::uint64_t i = 0; i < kDraws; ++i) {
    const double u = Random(9).uniform(1, i);
    ASSERT_GE(u, 0);
    ASSERT_LT(u, 1);
    ++counts[static_cast<std::size_t>(u * kBins)];
  }
  // 99 degrees of freedom: 0.1 % lie above 148.
  EXPECT_LT(chi_square(counts, kDraws / kBins), 148);
}

TEST(Random, NeighbouringStreamsAreIndependent) {
  constexpr std::size_t kBins = 10;
  constexpr int kDraws = 100'000;
  std::vector<int> counts(kBins * kBins);
  for (std::uint64_t i = 0; i < kDraws; ++i) {
    const auto a = static_cast<std::size_t>(Random(9).uniform(1, i) * kBins);
    const auto b = static_cast<std::size_t>(Random(9).uniform(2, i) * kBins);
    ++counts[a * kBins + b];
  }
  EXPECT_LT(chi_square(counts, 1.0 * kDraws / (kBins * kBins)), 148);
}

TEST(Random, NormalHasMeanZeroAndVarianceOne) {
  constexpr int kDraws = 200'000;
  double sum = 0;
  double squares = 0;
  double fourth = 0;
  for (std::uint64_t i = 0; i < kDraws; ++i) {
    const double x = Random(4).normal(7, i);
    ASSERT_TRUE(std::isfinite(x));
    sum += x;
    squares += x * x;
    fourth += x * x * x * x;
  }
  const double n = kDraws;
  EXPECT_NEAR(sum / n, 0, 4 / std::sqrt(n));
  EXPECT_NEAR(squares / n, 1, 4 * std::sqrt(2 / n));
  EXPECT_NEAR(fourth / n, 3, 4 * std::sqrt(96 / n));
}

TEST(Random, BelowStaysBelowAndIsEven) {
  std::vector<int> counts(7);
  for (std::uint64_t i = 0; i < 70'000; ++i) ++counts[Random(3).below(7, 0, i)];
  EXPECT_LT(chi_square(counts, 10'000), 22.5);  // 6 degrees of freedom, 0.1 %
  EXPECT_EQ(Random(3).below(1, 0, 0), 0U);
}

}  // namespace
}  // namespace saccade
