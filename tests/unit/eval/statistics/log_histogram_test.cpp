#include "eval/statistics/log_histogram.h"

#include <gtest/gtest.h>

namespace saccade {
namespace {

TEST(LogHistogram, BinsAreEquallyWideOnALogarithmicAxis) {
  LogHistogram histogram(2, 3, 4);
  ASSERT_EQ(histogram.bins(), 12U);
  EXPECT_DOUBLE_EQ(histogram.lower(0), 2);
  EXPECT_DOUBLE_EQ(histogram.lower(4), 20);
  EXPECT_DOUBLE_EQ(histogram.lower(12), 2000);
  EXPECT_NEAR(histogram.middle(5) / histogram.lower(5), histogram.lower(6) / histogram.middle(5),
              1e-12);
}

TEST(LogHistogram, ABinHoldsItsLowerEndAndNotItsUpperOne) {
  LogHistogram histogram(1, 7, 8);
  for (std::size_t bin = 0; bin < histogram.bins(); ++bin) histogram.add(histogram.lower(bin));
  for (std::size_t bin = 0; bin < histogram.bins(); ++bin) EXPECT_EQ(histogram.count(bin), 1U);
}

TEST(LogHistogram, ValuesOutsideGoToTheEnds) {
  LogHistogram histogram(1, 2, 1);
  for (const double value : {0.0, -3.0, 0.5, 99.0, 100.0, 1e9}) histogram.add(value);
  EXPECT_EQ(histogram.count(0), 3U);
  EXPECT_EQ(histogram.count(1), 3U);
}

TEST(LogHistogram, RanksCountFromTheLeast) {
  LogHistogram histogram(1, 2, 1);
  for (const double value : {20.0, 3.0, 30.0, 4.0, 5.0}) histogram.add(value);
  EXPECT_EQ(histogram.bin_of_rank(0), 0U);
  EXPECT_EQ(histogram.bin_of_rank(2), 0U);
  EXPECT_EQ(histogram.bin_of_rank(3), 1U);
  EXPECT_EQ(histogram.bin_of_rank(9), 1U);
}

}  // namespace
}  // namespace saccade
