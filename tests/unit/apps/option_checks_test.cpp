#include "apps/option_checks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace saccade {
namespace {

using ::testing::HasSubstr;

/// What the check says about a value; empty when it is right.
std::string verdict(const CLI::Validator& check, std::string value) { return check(value); }

TEST(OptionChecks, WholeNumbersAreDigitsInRange) {
  const CLI::Validator check = whole_number(1, 8);
  for (const char* right : {"1", "8", "08"}) EXPECT_EQ(verdict(check, right), "") << right;
  for (const char* wrong : {"0", "9", "-1", "+1", "1.5", "1e0", "two", "", " 1", "1 "})
    EXPECT_THAT(verdict(check, wrong),
                HasSubstr("expected a whole number from 1 to 8, got '" + std::string(wrong) + "'"));
}

TEST(OptionChecks, WholeNumbersDoNotWrap) {
  const CLI::Validator check = whole_number(0, std::numeric_limits<std::uint64_t>::max());
  EXPECT_EQ(verdict(check, "18446744073709551615"), "");
  EXPECT_NE(verdict(check, "18446744073709551616"), "");
  EXPECT_NE(verdict(check, "-1"), "");
}

TEST(OptionChecks, FiniteNumbersAreNeitherNanNorInfinite) {
  for (const char* right : {"0", "-1.5", "1e-3", "1e300"})
    EXPECT_EQ(verdict(finite_number(), right), "") << right;
  for (const char* wrong : {"nan", "inf", "-inf", "1e999", "1s", ""})
    EXPECT_THAT(verdict(finite_number(), wrong), HasSubstr("expected a finite number")) << wrong;
}

TEST(OptionChecks, PositiveNumbersAreAboveZero) {
  EXPECT_EQ(verdict(positive_number(), "1e-9"), "");
  for (const char* wrong : {"0", "-1", "nan"})
    EXPECT_THAT(verdict(positive_number(), wrong), HasSubstr("above 0")) << wrong;
}

TEST(OptionChecks, BoundsBelongToTheRange) {
  const CLI::Validator check = number_between(1, 240);
  for (const char* right : {"1", "240", "29.97"}) EXPECT_EQ(verdict(check, right), "") << right;
  for (const char* wrong : {"0.999", "240.1", "nan"})
    EXPECT_THAT(verdict(check, wrong), HasSubstr("expected a number from 1 to 240")) << wrong;
}

}  // namespace
}  // namespace saccade
