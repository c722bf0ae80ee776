#include "eval/statistics/signed_rank.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/random.h"

namespace saccade {
namespace {

TEST(SignedRank, CountsSignPatterns) {
  // All of n have one sign in 2 of 2^n patterns.
  const SignedRank all = signed_rank_test(std::vector<double>{1, 2, 3, 4, 5, 6});
  EXPECT_EQ(all.pairs, 6U);
  EXPECT_DOUBLE_EQ(all.effect, 1);
  EXPECT_DOUBLE_EQ(all.p, 2.0 / 64);
  // W- = 1: the sums 0 and 1 have one pattern each.
  const SignedRank one = signed_rank_test(std::vector<double>{-1, 2, 3, 4, 5, 6});
  EXPECT_DOUBLE_EQ(one.p, 4.0 / 64);
  EXPECT_DOUBLE_EQ(one.effect, 19.0 / 21);
}

TEST(SignedRank, SharesRanksAndDropsZeros) {
  // Ranks 1.5, 1.5, 3; W- = 1.5: the patterns with a sum of at most 1.5 are {}, {a}, {b}.
  const SignedRank tied = signed_rank_test(std::vector<double>{-1, 0, 1, 2});
  EXPECT_EQ(tied.pairs, 3U);
  EXPECT_DOUBLE_EQ(tied.p, 6.0 / 8);
  EXPECT_EQ(signed_rank_test(std::vector<double>{0, 0}).p, 1);
  EXPECT_EQ(signed_rank_test({}).pairs, 0U);
}

TEST(SignedRank, ExactAndNormalAgreeWhereTheyMeet) {
  const Random random(3);
  std::vector<double> differences;
  for (std::uint64_t i = 0; i < 51; ++i) differences.push_back(0.3 + random.normal(0, i));
  const double normal = signed_rank_test(differences).p;
  // The one nearest to zero has rank 1 and changes the sum by 1 of 1326.
  const auto least = std::min_element(differences.begin(), differences.end(),
                                      [](double a, double b) { return std::abs(a) < std::abs(b); });
  differences.erase(least);
  EXPECT_NEAR(signed_rank_test(differences).p, normal, 0.15 * normal);
}

TEST(SignedRank, HasTheStatedLevel) {
  const Random random(1);
  int below = 0;
  constexpr int kTrials = 2000;
  for (std::uint64_t trial = 0; trial < kTrials; ++trial) {
    std::vector<double> differences;
    for (std::uint64_t i = 0; i < 12; ++i) differences.push_back(random.normal(trial, i));
    below += signed_rank_test(differences).p <= 0.05;
  }
  // The test is exact and discrete: its level is 0.042 here; 4 standard deviations of 0.0045.
  EXPECT_NEAR(below / static_cast<double>(kTrials), 0.042, 0.018);
}

}  // namespace
}  // namespace saccade
