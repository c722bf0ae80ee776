#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "eval/picture/chart/axis.h"
#include "eval/picture/chart/bar_chart.h"
#include "eval/picture/chart/line_chart.h"

namespace saccade {
namespace {

using ::testing::ElementsAre;

TEST(Axis, IsLinearBelowADecade) {
  const Axis axis({2, 9}, true);
  EXPECT_FALSE(axis.is_logarithmic());
  EXPECT_THAT(axis.ticks(), ElementsAre(0, 2, 4, 6, 8, 10));
  EXPECT_DOUBLE_EQ(axis.position(0), 0);
  EXPECT_DOUBLE_EQ(axis.position(5), 0.5);
}

TEST(Axis, IsLogarithmicAboveADecade) {
  const Axis axis({25, 300, 2000}, true);
  EXPECT_TRUE(axis.is_logarithmic());
  EXPECT_THAT(axis.ticks(), ElementsAre(20, 50, 100, 200, 500, 1000, 2000));
  EXPECT_DOUBLE_EQ(axis.position(200), 0.5);
  EXPECT_FALSE(Axis({0, 2000}, true).is_logarithmic()) << "0 has no place on it";
  EXPECT_FALSE(Axis({-1, 2000}, true).is_logarithmic());
}

TEST(Axis, HoldsEveryValue) {
  for (const auto& values : std::vector<std::vector<double>>{{1, 50},
                                                             {0.05, 1},
                                                             {3, 3},
                                                             {0},
                                                             {-2, 5},
                                                             {1e-7, 1e6},
                                                             {0.999, 10.01},
                                                             {99, 1001},
                                                             {-0.31, -0.3},
                                                             {}}) {
    const Axis axis(values, false);
    ASSERT_GE(axis.ticks().size(), 2U);
    EXPECT_LE(axis.ticks().size(), 30U);
    for (const double value : values) {
      EXPECT_GE(axis.position(value), -1e-9);
      EXPECT_LE(axis.position(value), 1 + 1e-9);
    }
  }
}

TEST(Axis, WritesLargeNumbersShort) {
  EXPECT_EQ(Axis::text(0.05), "0.05");
  EXPECT_EQ(Axis::text(5000), "5000");
  EXPECT_EQ(Axis::text(20000), "20k");
  EXPECT_EQ(Axis::text(1.5e6), "1.5M");
}

bool shows(const ImageRgb8& image, const Rgb8& colour) {
  for (const Rgb8& pixel : image.pixels())
    if (pixel == colour) return true;
  return false;
}

TEST(LineChart, DrawsEveryLineInItsColour) {
  const LineChart chart{
      "samples",
      {"walls", "planes"},
      {{"dt_rel [%]", {{{25, {0.4, 0.3, 0.5}}, {2000, {0.1, 0.1, 0.1}}}, {{25, {0.2, 0.2, 0.2}}}}},
       {"poses/s", {{}, {{25, {20000, 20000, 20000}}}}}}};
  const ImageRgb8 picture = draw(chart, kLightTheme);
  EXPECT_GT(picture.width(), 700);
  EXPECT_TRUE(shows(picture, series_colour(0)));
  EXPECT_TRUE(shows(picture, series_colour(1)));
  EXPECT_FALSE(shows(picture, series_colour(2)));
}

/// Pixels of about a colour: a thin line is mixed with what is behind it.
std::ptrdiff_t tinted(const ImageRgb8& image, const Rgb8& colour) {
  return std::count_if(image.pixels().begin(), image.pixels().end(), [&](const Rgb8& pixel) {
    int most = 0;
    for (std::size_t k = 0; k < 3; ++k)
      most = std::max(most, std::abs(int{pixel[k]} - int{colour[k]}));
    return most < 70;
  });
}

TEST(LineChart, ACurveOverTimeIsThinOnLinearAxes) {
  LineChart chart{"time [s]", {}, {{"error [%]", {{{0.001, {0.1, 0.1, 0.1}}, {1, {9, 9, 9}}}}}}};
  const auto coloured = [](const ImageRgb8& picture) { return tinted(picture, series_colour(0)); };
  const auto with_dots = coloured(draw(chart, kLightTheme));
  chart.is_over_time = true;
  const ImageRgb8 picture = draw(chart, kLightTheme);
  // A line through the panel, hundreds of pixels long and without the dots at its ends.
  EXPECT_GT(coloured(picture), 100);
  EXPECT_LT(coloured(picture), with_dots * 2 / 3);
}

TEST(LineChart, SurvivesHavingNothingToShow) {
  (void)draw(LineChart{}, kLightTheme);
  (void)draw(LineChart{"x", {"a"}, {{"y", {{}}}}}, kLightTheme);
}

TEST(BarChart, DrawsEveryBarInItsColour) {
  const BarChart chart{{"none", "constant velocity"},
                       {"walls", "planes"},
                       {{"dt_rel [%]",
                         {{ChartValue{0.4, 0.3, 0.5}, std::nullopt},
                          {ChartValue{0.1, 0.1, 0.1}, ChartValue{0.2, 0.2, 0.2}}}}}};
  const ImageRgb8 picture = draw(chart, kLightTheme);
  EXPECT_TRUE(shows(picture, series_colour(0)));
  EXPECT_TRUE(shows(picture, series_colour(1)));
  (void)draw(BarChart{}, kLightTheme);
}

}  // namespace
}  // namespace saccade
