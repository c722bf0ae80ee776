#include "eval/report/charts/page_chart.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace saccade {
namespace {

TEST(CurvePoints, KeepTheExtremesOfEveryStretch) {
  std::vector<double> t_s, values;
  for (int i = 0; i < 20000; ++i) {
    t_s.push_back(i * 1e-3);
    values.push_back(i == 12345 ? 7 : i == 15000 ? -1 : 0.123456);
  }
  const CurvePoints points = thinned(t_s, values, 1600);
  EXPECT_LE(points.x.size(), 1600U);
  EXPECT_TRUE(std::is_sorted(points.x.begin(), points.x.end()));
  const auto peak = std::find(points.y.begin(), points.y.end(), 7.0);
  ASSERT_NE(peak, points.y.end());
  EXPECT_EQ(points.x[static_cast<std::size_t>(peak - points.y.begin())], 12.345);
  EXPECT_EQ(std::count(points.y.begin(), points.y.end(), -1.0), 1);
  EXPECT_DOUBLE_EQ(points.y.front(), 0.12346);
}

TEST(CurvePoints, SharesAscendToAHundredPercent) {
  std::vector<double> values;
  for (int i = 200; i >= 0; --i) values.push_back(i);
  const CurvePoints points = cumulative_percent(values);
  EXPECT_EQ(points.x.front(), 2) << "0 has no logarithm";
  EXPECT_EQ(points.y.front(), 1);
  EXPECT_EQ(points.x[49], 100);
  EXPECT_EQ(points.y[49], 50);
  EXPECT_EQ(points.x.back(), 200);
  EXPECT_EQ(points.y.back(), 100);
}

TEST(CurvePoints, OfEqualValuesTheLargestShareHolds) {
  const CurvePoints points = cumulative_percent({3, 1, 1, 1, 1});
  EXPECT_EQ(points.x, (std::vector<double>{1, 3}));
  EXPECT_EQ(points.y, (std::vector<double>{80, 100}));
  EXPECT_EQ(cumulative_percent({2, std::nan("")}).y, (std::vector<double>{100}));
  EXPECT_TRUE(cumulative_percent({}).x.empty());
  EXPECT_TRUE(cumulative_percent({0, 0}).x.empty());
}

TEST(PageChart, StylesAreByMethodAndTellNineApart) {
  std::vector<std::string> methods;
  for (int i = 0; i < 9; ++i) methods.push_back(std::to_string(i));
  const MethodStyles styles(methods);
  EXPECT_EQ(styles.curve("1").colour, "s1");
  EXPECT_EQ(styles.curve("8").colour, "s0");
  EXPECT_FALSE(styles.curve("0").dashed);
  EXPECT_TRUE(styles.curve("8").dashed);
}

TEST(PageChart, IsDescribedForTheScript) {
  ChartCurve line{"a", "s0", true};
  line.points.add(1, 2);
  ChartCurve point{"b", "s1", false, ChartCurve::Kind::kPoint};
  const PageChart chart{"w/x",        "Errors < 1", "t", {"x", true}, {"y", false, {{0, 100}}},
                        {line, point}};
  const nlohmann::json json = chart_json(chart);
  EXPECT_EQ(json["x"]["log"], true);
  EXPECT_FALSE(json["x"].contains("range"));
  EXPECT_EQ(json["y"]["range"], nlohmann::json({0.0, 100.0}));
  EXPECT_EQ(json["series"][0]["x"], nlohmann::json({1.0}));
  EXPECT_TRUE(json["series"][0].contains("dash"));
  EXPECT_FALSE(json["series"][0].contains("label"));
  EXPECT_EQ(json["series"][1]["label"], "b");
  EXPECT_EQ(chart_html(chart), "<div><h4>Errors &lt; 1</h4><div data-chart=\"w/x\"></div></div>\n");
}

}  // namespace
}  // namespace saccade
