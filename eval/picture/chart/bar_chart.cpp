#include "eval/picture/chart/bar_chart.h"

#include <algorithm>
#include <cmath>

#include "eval/picture/canvas/canvas.h"
#include "eval/picture/canvas/vector_drawing.h"
#include "eval/picture/chart/chart_elements.h"
#include "eval/table/number_text.h"

namespace saccade {
namespace {

constexpr int kPlotWidth = 250;
constexpr int kBar = 13;
constexpr int kRowGap = 12;
constexpr int kAbovePlots = 36;
constexpr int kBelowPlots = 30;
constexpr int kPanelGap = 70;  ///< between panels: room for the longest value

int row_height(const BarChart& chart) {
  return kBar * static_cast<int>(std::max<std::size_t>(1, chart.names.size())) + kRowGap;
}

int label_width(const BarChart& chart, const Drawing& drawing) {
  double width = 0;
  for (const std::string& category : chart.categories)
    width = std::max(width, drawing.extent_of(category, kChartLetters));
  return static_cast<int>(std::ceil(width)) + 28;
}

std::vector<double> values(const BarChart::Panel& panel) {
  std::vector<double> all;
  for (const auto& category : panel.bars)
    for (const auto& bar : category)
      if (bar) all.insert(all.end(), {bar->value, bar->low, bar->high});
  return all;
}

class BarPlot {
 public:
  BarPlot(Drawing& drawing, const BarChart& chart, const BarChart::Panel& panel, double left,
          const Theme& theme)
      : drawing_(drawing), left_(left), theme_(theme), axis_(values(panel), true) {
    const int rows = static_cast<int>(chart.categories.size()) * row_height(chart);
    draw_frame(panel.title, rows);
    for (std::size_t category = 0; category < panel.bars.size(); ++category)
      for (std::size_t name = 0; name < panel.bars[category].size(); ++name)
        if (const std::optional<ChartValue>& bar = panel.bars[category][name])
          draw_bar(*bar, name,
                   kAbovePlots + static_cast<int>(category) * row_height(chart) + kRowGap / 2 +
                       static_cast<int>(name) * kBar);
  }

 private:
  [[nodiscard]] double column(double value) const {
    return left_ + kPlotWidth * axis_.position(value);
  }

  void draw_frame(const std::string& title, int rows) {
    drawing_.text(title, {left_, kAbovePlots - 14.0}, theme_.text, kChartLetters + 1);
    draw_x_axis(drawing_, axis_, {left_, static_cast<double>(kAbovePlots)},
                {static_cast<double>(kPlotWidth), static_cast<double>(rows)}, kChartLetters - 1,
                theme_);
  }

  void draw_bar(const ChartValue& bar, std::size_t name, int top) {
    const double base = axis_.is_logarithmic() ? axis_.ticks().front() : 0;
    const double from = column(base), to = column(bar.value);
    drawing_.rectangle({std::min(from, to), static_cast<double>(top)},
                       {std::abs(to - from), kBar - 2.0}, series_colour(name));
    const double middle = top + (kBar - 2) / 2.0;
    if (bar.low < bar.high)
      drawing_.line({column(bar.low), middle}, {column(bar.high), middle}, theme_.text, 1);
    drawing_.text(rounded(bar.value), {std::max(to, column(bar.high)) + 5, middle + 4}, theme_.text,
                  kChartLetters - 1);
  }

  Drawing& drawing_;
  double left_;
  const Theme& theme_;
  Axis axis_;
};

int plots_height(const BarChart& chart) {
  return kAbovePlots + static_cast<int>(chart.categories.size()) * row_height(chart) + kBelowPlots;
}

Eigen::Vector2i size_of(const BarChart& chart, const Drawing& drawing) {
  const int width = label_width(chart, drawing) +
                    static_cast<int>(chart.panels.size()) * (kPlotWidth + kPanelGap);
  return {width, plots_height(chart) + legend_height(drawing, chart.names, width)};
}

void draw_on(Drawing& drawing, const BarChart& chart, int width, const Theme& theme) {
  const double labels = label_width(chart, drawing);
  for (std::size_t i = 0; i < chart.categories.size(); ++i) {
    const double middle = kAbovePlots + (static_cast<double>(i) + 0.5) * row_height(chart);
    drawing.text(chart.categories[i], {14, middle + 4}, theme.text, kChartLetters);
  }
  for (std::size_t i = 0; i < chart.panels.size(); ++i)
    const BarPlot plot(drawing, chart, chart.panels[i],
                       labels + static_cast<double>(i) * (kPlotWidth + kPanelGap), theme);
  draw_legend(drawing, chart.names, width, plots_height(chart), theme);
}

}  // namespace

ImageRgb8 draw(const BarChart& chart, const Theme& theme) {
  const Eigen::Vector2i size = size_of(chart, Canvas(1, 1, theme.background));
  Canvas canvas(size.x(), size.y(), theme.background);
  draw_on(canvas, chart, size.x(), theme);
  return canvas.image();
}

void save(const BarChart& chart, std::span<const std::filesystem::path> files) {
  VectorDrawing drawing;
  const Eigen::Vector2i size = size_of(chart, drawing);
  draw_on(drawing, chart, size.x(), kLightTheme);
  for (const std::filesystem::path& file : files) drawing.save(file, size.x(), size.y());
}

}  // namespace saccade
