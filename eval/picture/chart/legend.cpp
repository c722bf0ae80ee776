#include "eval/picture/chart/legend.h"

#include <Eigen/Core>

#include "eval/picture/chart/axis.h"

namespace saccade {
namespace {

constexpr int kLine = 20;
constexpr int kSideMargin = 14;
constexpr int kSwatch = 20;
constexpr int kNameGap = 22;

/// Where each name begins, filled row by row.
std::vector<Eigen::Vector2i> places(const std::vector<std::string>& names, int width) {
  std::vector<Eigen::Vector2i> all;
  Eigen::Vector2i at(kSideMargin, kLine / 2);
  for (const std::string& name : names) {
    const int length = kSwatch + Canvas::text_width(name, kChartLetters);
    if (at.x() > kSideMargin && at.x() + length > width - kSideMargin)
      at = Eigen::Vector2i(kSideMargin, at.y() + kLine);
    all.push_back(at);
    at.x() += length + kNameGap;
  }
  return all;
}

}  // namespace

int legend_height(const std::vector<std::string>& names, int width) {
  return names.empty() ? 0 : places(names, width).back().y() + kLine;
}

void draw_legend(Canvas& canvas, const std::vector<std::string>& names, int top,
                 const Theme& theme) {
  const std::vector<Eigen::Vector2i> all = places(names, canvas.width());
  for (std::size_t i = 0; i < names.size(); ++i) {
    const double x = all[i].x(), y = top + all[i].y();
    canvas.line({x, y}, {x + kSwatch - 8, y}, series_colour(i), 4);
    canvas.text(names[i], {x + kSwatch, y + 4}, theme.text, kChartLetters);
  }
}

}  // namespace saccade
