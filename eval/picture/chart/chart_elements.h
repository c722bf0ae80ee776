#pragma once

#include <string>
#include <vector>

#include "eval/picture/canvas/colour.h"
#include "eval/picture/canvas/drawing.h"
#include "eval/picture/chart/axis.h"

namespace saccade {

/// Height of the letters in charts, for Drawing::text().
inline constexpr double kChartLetters = 9;

/// Colour of the numbers at the ticks.
[[nodiscard]] Rgb8 tick_colour(const Theme& theme);

/// Draws the grid lines of a horizontal axis inside a plot, and the numbers below it; numbers that
/// would overlap are left out.
void draw_x_axis(Drawing& drawing, const Axis& axis, const Eigen::Vector2d& top_left,
                 const Eigen::Vector2d& size, double letters, const Theme& theme);

/// Height of the legend of a chart of this width [px], in the letters of `drawing`.
[[nodiscard]] int legend_height(const Drawing& drawing, const std::vector<std::string>& names,
                                int width);

/// Draws the names, each after a line of its colour, into the rows from `top` on of a chart of this
/// width.
void draw_legend(Drawing& drawing, const std::vector<std::string>& names, int width, int top,
                 const Theme& theme);

}  // namespace saccade
