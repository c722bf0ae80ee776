#include "eval/picture/chart/chart_elements.h"

#include <cmath>

#include <Eigen/Core>

namespace saccade {
namespace {

constexpr int kLine = 20;
constexpr int kSideMargin = 14;
constexpr int kSwatch = 20;
constexpr int kNameGap = 22;

/// The left end of each name; rows are filled one after another.
std::vector<Eigen::Vector2i> name_positions(const Drawing& drawing,
                                            const std::vector<std::string>& names, int width) {
  std::vector<Eigen::Vector2i> all;
  Eigen::Vector2i at(kSideMargin, kLine / 2);
  for (const std::string& name : names) {
    const int length =
        kSwatch + static_cast<int>(std::ceil(drawing.extent_of(name, kChartLetters)));
    if (at.x() > kSideMargin && at.x() + length > width - kSideMargin)
      at = Eigen::Vector2i(kSideMargin, at.y() + kLine);
    all.push_back(at);
    at.x() += length + kNameGap;
  }
  return all;
}

}  // namespace

Rgb8 tick_colour(const Theme& theme) { return mix(theme.faint, theme.text, 0.55); }

void draw_x_axis(Drawing& drawing, const Axis& axis, const Eigen::Vector2d& top_left,
                 const Eigen::Vector2d& size, double letters, const Theme& theme) {
  constexpr double kMinGap = 6;
  const double bottom = top_left.y() + size.y();
  double next_free_x = 0;
  for (const double tick : axis.ticks()) {
    const double x = top_left.x() + size.x() * axis.position(tick);
    drawing.line({x, top_left.y()}, {x, bottom}, theme.faint);
    const std::string text = Axis::text(tick);
    const double half = drawing.extent_of(text, letters) / 2;
    if (x - half < next_free_x) continue;
    drawing.text(text, {x - half, bottom + 16}, tick_colour(theme), letters);
    next_free_x = x + half + kMinGap;
  }
}

int legend_height(const Drawing& drawing, const std::vector<std::string>& names, int width) {
  return names.empty() ? 0 : name_positions(drawing, names, width).back().y() + kLine;
}

void draw_legend(Drawing& drawing, const std::vector<std::string>& names, int width, int top,
                 const Theme& theme) {
  const std::vector<Eigen::Vector2i> all = name_positions(drawing, names, width);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const double x = all[i].x(), y = top + all[i].y();
    drawing.line({x, y}, {x + kSwatch - 8, y}, series_colour(i), 4);
    drawing.text(names[i], {x + kSwatch, y + 4}, theme.text, kChartLetters);
  }
}

}  // namespace saccade
