#include "eval/report/charts/box_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "eval/picture/chart/axis.h"
#include "eval/report/html.h"

namespace saccade {
namespace {

/// Of the drawing, in its own units; the browser scales it to its column.
constexpr double kWidth = 560, kHeight = 240;
constexpr double kLeft = 62, kRight = 6, kTop = 8, kBottom = 28;

double quantile(const std::vector<double>& sorted, double fraction) {
  const double at = fraction * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return std::lerp(sorted[below], sorted[above], at - static_cast<double>(below));
}

class Drawing {
 public:
  explicit Drawing(const BoxPlot& plot) : plot_(plot), axis_(values(plot), true) {}

  [[nodiscard]] std::string svg() const {
    std::string text =
        fmt::format("<svg class=\"boxes\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\">",
                    kWidth, kHeight, escape_html(plot_.title));
    for (const double tick : axis_.ticks()) text += tick_svg(tick);
    text +=
        fmt::format("<text class=\"label\" transform=\"translate(12 {}) rotate(-90)\">{}</text>",
                    kHeight / 2, escape_html(plot_.y_label));
    const double group_width = (kWidth - kLeft - kRight) / static_cast<double>(plot_.groups.size());
    double left = kLeft;
    for (const BoxPlot::Group& group : plot_.groups) {
      text += group_svg(group, left, group_width);
      left += group_width;
    }
    return text + "</svg>\n";
  }

 private:
  static std::vector<double> values(const BoxPlot& plot) {
    std::vector<double> all;
    for (const BoxPlot::Group& group : plot.groups)
      for (const BoxPlot::Box& box : group.boxes)
        all.insert(all.end(), {box.numbers.low, box.numbers.high});
    return all;
  }

  [[nodiscard]] double y(double value) const {
    return kHeight - kBottom - axis_.position(value) * (kHeight - kTop - kBottom);
  }

  [[nodiscard]] std::string tick_svg(double tick) const {
    return fmt::format(
        "<line class=\"rule\" x1=\"{}\" x2=\"{}\" y1=\"{:.1f}\" y2=\"{:.1f}\"/>"
        "<text class=\"tick\" x=\"{}\" y=\"{:.1f}\">{}</text>",
        kLeft, kWidth - kRight, y(tick), y(tick), kLeft - 6, y(tick) + 4, Axis::text(tick));
  }

  [[nodiscard]] std::string group_svg(const BoxPlot::Group& group, double left,
                                      double width) const {
    constexpr double kGap = 0.2;  // of the width of a group, between it and the next
    std::string text = fmt::format("<text class=\"label\" x=\"{:.1f}\" y=\"{}\">{}</text>",
                                   left + width / 2, kHeight - 8, escape_html(group.label));
    const double step = width * (1 - kGap) / static_cast<double>(group.boxes.size());
    double middle = left + width * kGap / 2 + step / 2;
    for (const BoxPlot::Box& box : group.boxes) {
      text += box_svg(box, middle, 0.7 * step);
      middle += step;
    }
    return text;
  }

  [[nodiscard]] std::string box_svg(const BoxPlot::Box& box, double middle, double width) const {
    const BoxNumbers& n = box.numbers;
    const double half = width / 2;
    return fmt::format(
        "<g style=\"stroke:var(--{0});fill:var(--{0})\"><title>{1}: median {2:.4g}, quartiles "
        "{3:.4g} to {4:.4g}, 90 % of the values {5:.4g} to {6:.4g}</title>"
        "<path class=\"whisker\" d=\"M{7:.1f} {8:.1f}V{9:.1f}M{7:.1f} {10:.1f}V{11:.1f}\"/>"
        "<rect x=\"{12:.1f}\" y=\"{9:.1f}\" width=\"{13:.1f}\" height=\"{14:.1f}\"/>"
        "<path d=\"M{12:.1f} {15:.1f}h{13:.1f}\"/></g>",
        box.colour, escape_html(box.name), n.middle, n.lower_quartile, n.upper_quartile, n.low,
        n.high, middle, y(n.high), y(n.upper_quartile), y(n.lower_quartile), y(n.low),
        middle - half, width, y(n.lower_quartile) - y(n.upper_quartile), y(n.middle));
  }

  const BoxPlot& plot_;
  Axis axis_;
};

}  // namespace

std::optional<BoxNumbers> box_numbers(std::vector<double> values) {
  if (values.empty()) return std::nullopt;
  std::sort(values.begin(), values.end());
  return BoxNumbers{quantile(values, 0.05), quantile(values, 0.25), quantile(values, 0.5),
                    quantile(values, 0.75), quantile(values, 0.95)};
}

std::string box_plot_svg(const BoxPlot& plot) {
  const bool has_boxes =
      std::any_of(plot.groups.begin(), plot.groups.end(),
                  [](const BoxPlot::Group& group) { return !group.boxes.empty(); });
  return has_boxes ? Drawing(plot).svg() : "";
}

}  // namespace saccade
