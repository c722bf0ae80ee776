#include "eval/picture/canvas/colour_bar.h"

#include <fmt/format.h>

#include <utility>

#include "eval/picture/canvas/canvas.h"

namespace saccade {

ImageRgb8 with_colour_bar(ImageRgb8 picture, const std::function<Rgb8(double)>& colour,
                          const std::string& left_text, const std::string& right_text) {
  Canvas canvas(std::move(picture));
  const int left = canvas.width() / 2;
  const int right = canvas.width() - 12;
  const int bottom = canvas.height() - 10;
  for (int x = left; x <= right; ++x)
    canvas.line(Eigen::Vector2d(x, bottom), Eigen::Vector2d(x, bottom - 8),
                colour(static_cast<double>(x - left) / (right - left)));
  const auto label = [&](const std::string& text, double x) {
    for (const auto& [dx, dy] : {std::pair{1, 1}, {-1, 1}, {1, -1}, {-1, -1}})
      canvas.text(text, Eigen::Vector2d(x + dx, bottom - 13 + dy), {0, 0, 0});
    canvas.text(text, Eigen::Vector2d(x, bottom - 13), {255, 255, 255});
  };
  label(left_text, left);
  label(right_text, right - Canvas::text_width(right_text));
  return canvas.image();
}

ImageRgb8 with_depth_bar(ImageRgb8 picture, const DepthRange& range) {
  const auto colour = [&](double fraction) {
    return depth_colour(1 / ((1 - fraction) / range.near_m + fraction / range.far_m), range);
  };
  return with_colour_bar(std::move(picture), colour, fmt::format("{:.3g} m", range.near_m),
                         fmt::format("{:.3g} m", range.far_m));
}

}  // namespace saccade
