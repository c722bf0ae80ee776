#include "eval/table/number_text.h"

#include <gtest/gtest.h>

namespace saccade {
namespace {

TEST(NumberText, ShowsNumbersForPeople) {
  EXPECT_EQ(significant(0.012345), "0.0123");
  EXPECT_EQ(significant(1.0), "1.00");
  EXPECT_EQ(significant(123456.0), "123000");
  EXPECT_EQ(significant(-2.5, 2), "-2.5");
  EXPECT_EQ(significant(0.0), "0");
  EXPECT_EQ(significant(std::nullopt), "–");
  EXPECT_EQ(fixed(1.25, 1), "1.2");
  EXPECT_EQ(grouped(1234567.0), "1,234,567");
  EXPECT_EQ(grouped(999.0), "999");
  EXPECT_EQ(grouped(-1234.0), "-1,234");
  EXPECT_EQ(grouped(-123.0), "-123");
}

}  // namespace
}  // namespace saccade
