#pragma once

#include <string>
#include <vector>

#include "eval/picture/canvas/canvas.h"
#include "eval/picture/canvas/colour.h"

namespace saccade {

/// Size of the letters in charts, for Canvas::text().
inline constexpr double kChartLetters = 9;

/// Height of the names of a chart's lines or bars in a picture of this width [px].
[[nodiscard]] int legend_height(const std::vector<std::string>& names, int width);

/// Writes the names, each behind its colour, into the rows from `top` on.
void draw_legend(Canvas& canvas, const std::vector<std::string>& names, int top,
                 const Theme& theme);

}  // namespace saccade
