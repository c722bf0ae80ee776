#pragma once

#include <string>
#include <vector>

#include "core/image.h"
#include "eval/picture/chart/axis.h"
#include "eval/picture/canvas/colour.h"

namespace saccade {

/// Several quantities over the same x, each in a panel of its own; the same lines in each of them.
struct LineChart {
  struct Point {
    double x;
    ChartValue y;
  };
  struct Panel {
    std::string title;                      ///< quantity and unit
    std::vector<std::vector<Point>> lines;  ///< one for each name, ascending in x; may be empty
    std::string x_label = {};               ///< where it is not the chart's
  };

  std::string x_label;
  std::vector<std::string> names;  ///< of the lines
  std::vector<Panel> panels;
};

/// Panels side by side above the names of the lines. A range is drawn as a bar through its point.
[[nodiscard]] ImageRgb8 draw(const LineChart& chart, const Theme& theme);

}  // namespace saccade
