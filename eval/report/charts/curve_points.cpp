#include "eval/report/charts/curve_points.h"

#include <algorithm>
#include <cmath>

namespace saccade {
namespace {

/// Indices of the smallest and largest value of each of at most `most` / 2 stretches.
std::vector<std::size_t> peaks(std::span<const double> values, std::size_t most) {
  std::vector<std::size_t> kept;
  const std::size_t stretch = std::max<std::size_t>(1, (2 * values.size() + most - 1) / most);
  for (std::size_t begin = 0; begin < values.size(); begin += stretch) {
    const auto first = values.begin() + static_cast<std::ptrdiff_t>(begin);
    const auto last =
        values.begin() + static_cast<std::ptrdiff_t>(std::min(begin + stretch, values.size()));
    const auto [low, high] = std::minmax_element(first, last);
    auto a = static_cast<std::size_t>(low - values.begin());
    auto b = static_cast<std::size_t>(high - values.begin());
    if (a > b) std::swap(a, b);
    kept.push_back(a);
    if (b != a) kept.push_back(b);
  }
  return kept;
}

}  // namespace

double five_digits(double value) {
  if (value == 0 || !std::isfinite(value)) return 0;
  const double unit = std::pow(10, std::floor(std::log10(std::abs(value))) - 4);
  return std::round(value / unit) * unit;
}

double tenth_ms(double t_s) { return std::round(t_s * 1e4) / 1e4; }

CurvePoints thinned(std::span<const double> t_s, std::span<const double> values, std::size_t most) {
  CurvePoints points;
  const auto keep = [&](std::size_t i) { points.add(tenth_ms(t_s[i]), five_digits(values[i])); };
  if (values.size() <= most)
    for (std::size_t i = 0; i < values.size(); ++i) keep(i);
  else
    for (const std::size_t i : peaks(values, most)) keep(i);
  return points;
}

CurvePoints cumulative_percent(std::vector<double> values) {
  std::erase_if(values, [](double value) { return std::isnan(value); });
  std::sort(values.begin(), values.end());
  CurvePoints points;
  for (std::size_t percent = 1; percent <= 100 && !values.empty(); ++percent) {
    // The least value that so many of a hundred do not exceed.
    const double value = five_digits(values[(percent * values.size() + 99) / 100 - 1]);
    // uPlot asks for ascending x: of equal values the largest fraction counts.
    if (!points.x.empty() && points.x.back() == value)
      points.y.back() = static_cast<double>(percent);
    else if (value > 0)
      points.add(value, static_cast<double>(percent));
  }
  return points;
}

}  // namespace saccade
