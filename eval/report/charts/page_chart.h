#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "eval/report/charts/curve_points.h"

namespace saccade {

/// A series of a chart on the page.
struct ChartCurve {
  enum class Kind {
    kLine,
    kPoint,  ///< a point with the name beside it
    kFront,  ///< steps between the points that no other one beats
  };

  std::string name;
  std::string colour;  ///< custom property of web/style.css, "s0"
  bool dashed = false;
  Kind kind = Kind::kLine;
  CurvePoints points = {};
};

/// A chart as web/src/chart.js draws it.
struct PageChart {
  struct Axis {
    std::string label;
    bool log = false;                                     ///< values are above 0
    std::optional<std::pair<double, double>> range = {};  ///< default: that of the values
  };

  std::string id;       ///< unique on the page
  std::string heading;  ///< plain text, above it
  std::string title;    ///< plain text, of its file and for those who cannot see it
  Axis x, y;
  std::vector<ChartCurve> curves;
};

/// What stands for each method in all charts of a page: a colour, dashed once the eight are used
/// up.
class MethodStyles {
 public:
  /// `methods`: each once.
  explicit MethodStyles(std::vector<std::string> methods) : methods_(std::move(methods)) {}

  /// A curve without points. Contract: one of the methods.
  [[nodiscard]] ChartCurve curve(const std::string& method) const;

 private:
  std::vector<std::string> methods_;
};

/// The box that the script draws it in, below its heading.
[[nodiscard]] std::string chart_html(const PageChart& chart);

/// Appends the charts to those of the page and returns a grid of their boxes; empty without charts.
[[nodiscard]] std::string chart_grid(const std::vector<PageChart>& charts,
                                     std::vector<PageChart>& page);

/// {"id", "title", "x": {"label", "log", "range"}, "y", "series": [{"name", "colour", "x", "y",
/// ...}]}: the description that chart.js takes.
[[nodiscard]] nlohmann::json chart_json(const PageChart& chart);

}  // namespace saccade
