#include "eval/picture/chart/line_chart.h"

#include <algorithm>

#include "eval/picture/canvas/canvas.h"
#include "eval/picture/canvas/vector_drawing.h"
#include "eval/picture/chart/chart_elements.h"

namespace saccade {
namespace {

using Eigen::Vector2d;

constexpr int kPanelWidth = 400;
constexpr int kPanelHeight = 330;
/// From the panel's edges to the frame of its plot.
constexpr double kLeft = 62, kRight = 18, kTop = 34, kBottom = 46;

/// One panel with its two axes.
class LinePlot {
 public:
  LinePlot(Drawing& drawing, const LineChart& chart, const LineChart::Panel& panel, double left,
           const Theme& theme)
      : drawing_(drawing),
        panel_(panel),
        is_over_time_(chart.is_over_time),
        left_(left + kLeft),
        theme_(theme),
        x_(values(chart, panel, false), false),
        y_(values(chart, panel, true), true) {
    draw_frame(panel.x_label.empty() ? chart.x_label : panel.x_label);
    for (std::size_t i = 0; i < panel.lines.size(); ++i) draw_line(i);
  }

 private:
  static std::vector<double> values(const LineChart& chart, const LineChart::Panel& panel,
                                    bool of_y) {
    std::vector<double> all;
    if (chart.is_over_time) all.push_back(0);  // which also makes the axis linear
    for (const auto& line : panel.lines)
      for (const LineChart::Point& point : line) {
        if (of_y)
          all.insert(all.end(), {point.y.value, point.y.low, point.y.high});
        else
          all.push_back(point.x);
      }
    return all;
  }

  [[nodiscard]] static double width() { return kPanelWidth - kLeft - kRight; }
  [[nodiscard]] static double height() { return kPanelHeight - kTop - kBottom; }
  [[nodiscard]] double column(double x) const { return left_ + width() * x_.position(x); }
  [[nodiscard]] double row(double y) const { return kTop + height() * (1 - y_.position(y)); }

  void draw_frame(const std::string& x_label) {
    const double right = left_ + width(), bottom = kTop + height();
    const Rgb8 grey = tick_colour(theme_);
    for (const double tick : y_.ticks()) {
      drawing_.line({left_, row(tick)}, {right, row(tick)}, theme_.faint);
      const std::string text = Axis::text(tick);
      drawing_.text(text, {left_ - 6 - drawing_.extent_of(text, kChartLetters), row(tick) + 4},
                    grey, kChartLetters);
    }
    draw_x_axis(drawing_, x_, {left_, kTop}, {width(), height()}, kChartLetters, theme_);
    drawing_.text(panel_.title, {left_, kTop - 13}, theme_.text, kChartLetters + 1);
    const double middle = left_ + width() / 2 - drawing_.extent_of(x_label, kChartLetters) / 2;
    drawing_.text(x_label, {middle, bottom + 36}, theme_.text, kChartLetters);
  }

  void draw_line(std::size_t index) {
    const Rgb8 colour = series_colour(index);
    std::vector<Vector2d> points;
    for (const LineChart::Point& point : panel_.lines[index])
      points.emplace_back(column(point.x), row(point.y.value));
    if (is_over_time_) return drawing_.polyline(points, colour);
    for (const LineChart::Point& point : panel_.lines[index])
      drawing_.line({column(point.x), row(point.y.low)}, {column(point.x), row(point.y.high)},
                    mix(theme_.background, colour, 0.5), 2);
    drawing_.polyline(points, colour, 2);
    for (const Vector2d& point : points) drawing_.disc(point, 3.2, colour);
  }

  Drawing& drawing_;
  const LineChart::Panel& panel_;
  bool is_over_time_;
  double left_;
  const Theme& theme_;
  Axis x_;
  Axis y_;
};

int plots_height(const LineChart& chart) { return chart.panels.empty() ? 0 : kPanelHeight; }

Eigen::Vector2i size_of(const LineChart& chart, const Drawing& drawing) {
  const int width = kPanelWidth * std::max(1, static_cast<int>(chart.panels.size()));
  return {width, plots_height(chart) + legend_height(drawing, chart.names, width)};
}

void draw_on(Drawing& drawing, const LineChart& chart, int width, const Theme& theme) {
  for (std::size_t i = 0; i < chart.panels.size(); ++i)
    const LinePlot plot(drawing, chart, chart.panels[i], static_cast<double>(i) * kPanelWidth,
                        theme);
  draw_legend(drawing, chart.names, width, plots_height(chart), theme);
}

}  // namespace

ImageRgb8 draw(const LineChart& chart, const Theme& theme) {
  const Eigen::Vector2i size = size_of(chart, Canvas(1, 1, theme.background));
  Canvas canvas(size.x(), size.y(), theme.background);
  draw_on(canvas, chart, size.x(), theme);
  return canvas.image();
}

void save(const LineChart& chart, std::span<const std::filesystem::path> files) {
  VectorDrawing drawing;
  const Eigen::Vector2i size = size_of(chart, drawing);
  draw_on(drawing, chart, size.x(), kLightTheme);
  for (const std::filesystem::path& file : files) drawing.save(file, size.x(), size.y());
}

}  // namespace saccade
