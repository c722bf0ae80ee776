#include "eval/metrics/statistics.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace saccade {
namespace {

TEST(Statistics, FourNumbersOfAHandComputedSample) {
  // mean 10/4, squares 1 + 4 + 9 + 16 = 30, deviations 2.25 + 0.25 + 0.25 + 2.25 = 5.
  const Statistics s = statistics_of(std::vector<double>{1, 2, 3, 4});
  EXPECT_DOUBLE_EQ(s.mean, 2.5);
  EXPECT_DOUBLE_EQ(s.sigma, std::sqrt(5.0 / 4));
  EXPECT_DOUBLE_EQ(s.max, 4);
  EXPECT_DOUBLE_EQ(s.rmse, std::sqrt(30.0 / 4));
}

TEST(Statistics, SigmaSurvivesALargeMean) {
  const Statistics s = statistics_of(std::vector<double>{1e9 + 1, 1e9 - 1});
  EXPECT_DOUBLE_EQ(s.sigma, 1);
}

TEST(Statistics, OneSampleHasNoSpread) {
  const Statistics s = statistics_of(std::vector<double>{0.3});
  EXPECT_EQ(s.mean, 0.3);
  EXPECT_EQ(s.sigma, 0);
}

TEST(Statistics, NothingIsNull) {
  Metrics metrics;
  set_statistics(metrics, "k", {});
  EXPECT_EQ(metrics.values().size(), 4U);
  EXPECT_EQ(metrics.get("k.mean"), std::nullopt);
}

TEST(Statistics, WilsonsIntervalIsThatOfTheTables) {
  // 8 of 10 (Agresti & Coull, 1998): 0.490 to 0.943.
  EXPECT_NEAR(wilson_95(8, 10).low, 0.4902, 1e-4);
  EXPECT_NEAR(wilson_95(8, 10).high, 0.9433, 1e-4);
  // At the ends z^2 / (n + z^2) remains: 3.8415 / 8.8415.
  EXPECT_NEAR(wilson_95(5, 5).low, 1 - 0.43448, 1e-4);
  EXPECT_EQ(wilson_95(5, 5).high, 1);
  EXPECT_EQ(wilson_95(0, 5).low, 0);
  EXPECT_NEAR(wilson_95(0, 5).high, 0.43448, 1e-4);
}

TEST(Statistics, StudentsQuantileIsThatOfTheTables) {
  EXPECT_NEAR(student_95(1), 12.7062, 1e-3);
  EXPECT_NEAR(student_95(9), 2.2622, 1e-3);
  EXPECT_NEAR(student_95(10), 2.2281, 3e-3);
  EXPECT_NEAR(student_95(20), 2.0860, 3e-3);
  EXPECT_NEAR(student_95(100), 1.9840, 3e-3);
}

}  // namespace
}  // namespace saccade
