#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/image.h"
#include "eval/picture/canvas/colour.h"
#include "eval/picture/chart/axis.h"

namespace saccade {

/// Several quantities over the same x, one panel each; all panels have the same lines.
struct LineChart {
  struct Point {
    double x;
    ChartValue y;
  };
  struct Panel {
    std::string title;                      ///< quantity and unit
    std::vector<std::vector<Point>> lines;  ///< one per name, ascending in x; may be empty
    std::string x_label = {};               ///< where it differs from the chart's
  };

  std::string x_label;
  std::vector<std::string> names;  ///< of the lines
  std::vector<Panel> panels;
  /// Curves of many points over time: thin and without dots, both axes linear from 0.
  bool is_over_time = false;
};

/// Panels side by side above the legend. The range of a value is a vertical bar.
[[nodiscard]] ImageRgb8 draw(const LineChart& chart, const Theme& theme);

/// Writes it for papers into files that end with .pdf or .svg (VectorDrawing::save()).
void save(const LineChart& chart, std::span<const std::filesystem::path> files);

}  // namespace saccade
