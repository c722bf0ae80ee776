#include "eval/report/html.h"

#include <gtest/gtest.h>

#include "eval/number_text.h"
#include "eval/report/thesis.h"

namespace saccade {
namespace {

TEST(Html, EscapesWhatMeansSomething) {
  EXPECT_EQ(escape_html("<a href=\"x\">&'b'"), "&lt;a href=&quot;x&quot;&gt;&amp;&#39;b&#39;");
}

TEST(Html, Base64OfTheStandardsVectors) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foob"), "Zm9vYg==");
  EXPECT_EQ(base64("fooba"), "Zm9vYmE=");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64("\xff\xfe"), "//4=");
}

TEST(Html, FillsAPageWithoutSearchingTheValues) {
  EXPECT_EQ(fill_page("a {{x}} b {{y}}", {{"x", "{{y}}"}, {"y", "2"}}), "a {{y}} b 2");
}

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

TEST(Thesis, HasItsTablesByName) {
  EXPECT_EQ(thesis::find_sequence("Walls")->events_millions, 1.8);
  EXPECT_EQ(thesis::find_sequence("desk"), nullptr);
  EXPECT_EQ(thesis::find_tracking("office", false)->dt_rel_percent.max, 4.9);
  EXPECT_EQ(thesis::find_tracking("walls", true)->poses_per_s, 11427);
  EXPECT_EQ(thesis::find_tracking("planes", true), nullptr);
  // The erratum: the rate follows from the events and the time, not from what is printed.
  const thesis::Tracking& fast = *thesis::find_tracking("walls", true);
  EXPECT_NEAR(fast.events_per_s_millions,
              thesis::find_sequence("walls")->events_millions / (fast.time_ms * 1e-3), 0.5);
}

}  // namespace
}  // namespace saccade
