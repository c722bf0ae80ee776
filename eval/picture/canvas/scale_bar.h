#pragma once

#include <fmt/format.h>
#include <cmath>

#include "eval/picture/canvas/canvas.h"
#include "eval/picture/canvas/colour.h"

namespace saccade {

/// Draws a scale bar of 1, 2 or 5 times a power of ten metres, the longest within a third of the
/// width, into the lower left corner. `px_per_m` > 0.
inline void draw_scale_bar(Canvas& canvas, double px_per_m, const Theme& theme) {
  const double longest_m = canvas.width() / 3.0 / px_per_m;
  const double power_m = std::pow(10, std::floor(std::log10(longest_m)));
  const double ratio = longest_m / power_m;
  const double length_m = power_m * (ratio >= 5 ? 5 : ratio >= 2 ? 2 : 1);
  const Eigen::Vector2d start(12, canvas.height() - 12);
  canvas.line(start, start + Eigen::Vector2d(px_per_m * length_m, 0), theme.text);
  canvas.text(fmt::format("{:.3g} m", length_m), start - Eigen::Vector2d(0, 5), theme.text);
}

}  // namespace saccade
