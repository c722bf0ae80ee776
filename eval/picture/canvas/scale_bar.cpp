#include "eval/picture/canvas/scale_bar.h"

#include <fmt/format.h>

#include <cmath>

namespace saccade {

void draw_scale_bar(Canvas& canvas, double px_per_m, const Theme& theme) {
  const double longest_m = canvas.width() / 3.0 / px_per_m;
  const double power_m = std::pow(10, std::floor(std::log10(longest_m)));
  const double ratio = longest_m / power_m;
  const double length_m = power_m * (ratio >= 5 ? 5 : ratio >= 2 ? 2 : 1);
  const Eigen::Vector2d start(12, canvas.height() - 12);
  canvas.line(start, start + Eigen::Vector2d(px_per_m * length_m, 0), theme.text);
  canvas.text(fmt::format("{:.3g} m", length_m), start - Eigen::Vector2d(0, 5), theme.text);
}

}  // namespace saccade
