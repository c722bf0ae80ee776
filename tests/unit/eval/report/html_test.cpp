#include "eval/report/html.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace saccade
