#include "eval/report/charts/box_plot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace saccade {
namespace {

using ::testing::HasSubstr;

TEST(BoxNumbers, AreQuantiles) {
  std::vector<double> values;
  for (int i = 100; i >= 0; --i) values.push_back(i);
  const std::optional<BoxNumbers> box = box_numbers(values);
  ASSERT_TRUE(box);
  EXPECT_DOUBLE_EQ(box->low, 5);
  EXPECT_DOUBLE_EQ(box->lower_quartile, 25);
  EXPECT_DOUBLE_EQ(box->middle, 50);
  EXPECT_DOUBLE_EQ(box->upper_quartile, 75);
  EXPECT_DOUBLE_EQ(box->high, 95);
  EXPECT_DOUBLE_EQ(box_numbers({1, 2})->middle, 1.5);
  EXPECT_FALSE(box_numbers({}));
}

TEST(BoxPlot, DrawsABoxPerMethodAndGroup) {
  const BoxNumbers numbers{1, 2, 3, 4, 5};
  const std::string svg = box_plot_svg(
      {"errors", "error [%]", {{"10 %", {{"a <b>", "s0", numbers}, {"c", "s1", numbers}}}}});
  EXPECT_THAT(svg, HasSubstr("a &lt;b&gt;: median 3"));
  EXPECT_THAT(svg, HasSubstr("var(--s1)"));
  EXPECT_EQ(box_plot_svg({"errors", "error [%]", {}}), "");
}

}  // namespace
}  // namespace saccade
