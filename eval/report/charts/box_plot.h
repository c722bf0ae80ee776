#pragma once

#include <optional>
#include <string>
#include <vector>

namespace saccade {

/// The five numbers of a box: the quartiles, and the 5 % and 95 % quantiles as whiskers, which
/// unlike the extremes do not grow with the number of values.
struct BoxNumbers {
  double low = 0, lower_quartile = 0, middle = 0, upper_quartile = 0, high = 0;
};
/// Quantiles are interpolated between the sorted values. nullopt without a value.
[[nodiscard]] std::optional<BoxNumbers> box_numbers(std::vector<double> values);

/// Boxes in groups along the x axis.
struct BoxPlot {
  struct Box {
    std::string name;    ///< of its series, for the tooltip
    std::string colour;  ///< custom property of web/style.css, "s0"
    BoxNumbers numbers;
  };
  struct Group {
    std::string label;
    std::vector<Box> boxes;
  };

  std::string title;  ///< plain text, for those who cannot see it
  std::string y_label;
  std::vector<Group> groups;
};

/// The plot as an SVG element in the colours of the page; its y axis is logarithmic where the values
/// span more than a decade. Empty without boxes.
[[nodiscard]] std::string box_plot_svg(const BoxPlot& plot);

}  // namespace saccade
