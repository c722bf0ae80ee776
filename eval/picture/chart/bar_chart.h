#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/image.h"
#include "eval/picture/canvas/colour.h"
#include "eval/picture/chart/axis.h"

namespace saccade {

/// Several quantities compared between categories, one panel each.
struct BarChart {
  struct Panel {
    std::string title;                                         ///< quantity and unit
    std::vector<std::vector<std::optional<ChartValue>>> bars;  ///< by category, then by name
  };

  std::vector<std::string> categories;
  std::vector<std::string> names;  ///< of the bars of a category
  std::vector<Panel> panels;
};

/// Lying bars, a row for each category, panels side by side above the names. A range is drawn as a
/// line over its bar. A bar on a logarithmic axis begins at the low end.
[[nodiscard]] ImageRgb8 draw(const BarChart& chart, const Theme& theme);

/// Writes it for papers into files that end with .pdf or .svg (VectorDrawing::save()).
void save(const BarChart& chart, std::span<const std::filesystem::path> files);

}  // namespace saccade
