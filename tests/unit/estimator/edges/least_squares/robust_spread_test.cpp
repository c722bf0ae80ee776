#include "estimator/edges/least_squares/robust_spread.h"

#include <gtest/gtest.h>

#include <vector>

namespace saccade {
namespace {

double weighted(std::vector<WeightedValue> values) { return weighted_median(values); }

TEST(WeightedMedian, HasHalfOfTheWeightOnEitherSide) {
  EXPECT_EQ(weighted({{3, 1}, {1, 1}, {2, 1}}), 2);
  EXPECT_EQ(weighted({{3, 5}, {1, 1}, {2, 1}}), 3) << "by weight, not by number";
  EXPECT_EQ(weighted({{-4, 0.1}, {7, 0.3}, {5, 0.3}}), 5);
  EXPECT_EQ(weighted({{8, 0}, {1, 2}}), 1) << "without weight no say";
  EXPECT_EQ(weighted({}), 0);
}

}  // namespace
}  // namespace saccade
