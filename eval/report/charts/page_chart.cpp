#include "eval/report/charts/page_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/check.h"
#include "eval/report/html.h"

namespace saccade {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kColours = 8;  ///< --s0 to --s7 of web/style.css

Json axis_json(const PageChart::Axis& axis) {
  Json json{{"label", axis.label}, {"log", axis.log}};
  if (axis.range) json["range"] = {axis.range->first, axis.range->second};
  return json;
}

Json curve_json(const ChartCurve& curve) {
  Json json{
      {"name", curve.name}, {"colour", curve.colour}, {"x", curve.points.x}, {"y", curve.points.y}};
  if (curve.dashed) json["dash"] = {6, 4};
  if (curve.kind == ChartCurve::Kind::kPoint)
    json.update({{"points", true}, {"label", curve.name}});
  if (curve.kind == ChartCurve::Kind::kFront) json["step"] = true;
  return json;
}

}  // namespace

ChartCurve MethodStyles::curve(const std::string& method) const {
  const auto found = std::find(methods_.begin(), methods_.end(), method);
  SACCADE_CHECK(found != methods_.end());
  const auto index = static_cast<std::size_t>(found - methods_.begin());
  ChartCurve curve;
  curve.name = method;
  curve.colour = fmt::format("s{}", index % kColours);
  curve.dashed = index / kColours % 2 == 1;
  return curve;
}

std::string chart_html(const PageChart& chart) {
  return fmt::format("<div><h4>{}</h4><div data-chart=\"{}\"></div></div>\n",
                     escape_html(chart.heading), escape_html(chart.id));
}

std::string chart_grid(const std::vector<PageChart>& charts, std::vector<PageChart>& page) {
  if (charts.empty()) return "";
  std::string html = "<div class=\"grid\">\n";
  for (const PageChart& chart : charts) html += chart_html(chart);
  page.insert(page.end(), charts.begin(), charts.end());
  return html + "</div>\n";
}

Json chart_json(const PageChart& chart) {
  Json json{{"id", chart.id},
            {"title", chart.title},
            {"x", axis_json(chart.x)},
            {"y", axis_json(chart.y)},
            {"series", Json::array()}};
  for (const ChartCurve& curve : chart.curves) json["series"].push_back(curve_json(curve));
  return json;
}

}  // namespace saccade
