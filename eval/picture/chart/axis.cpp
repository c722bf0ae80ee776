#include "eval/picture/chart/axis.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace saccade {
namespace {

constexpr double kDecade = 10;
constexpr double kIntervals = 5;  // about so many between the ticks
/// Tolerance for the rounding of divisions by the tick spacing.
constexpr double kSlack = 1e-9;

/// The smallest of 1, 2, 5 times a power of ten that is at least `spacing`.
double round_spacing(double spacing) {
  const double decade = std::pow(10, std::floor(std::log10(spacing) + kSlack));
  for (const double factor : {1.0, 2.0, 5.0})
    if (spacing <= factor * decade * (1 + kSlack)) return factor * decade;
  return 10 * decade;
}

}  // namespace

Axis::Axis(const std::vector<double>& values, bool from_zero) {
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  double low = values.empty() ? 0 : *least;
  double high = values.empty() ? 1 : *most;
  is_logarithmic_ = low > 0 && high / low > kDecade;
  if (from_zero && !is_logarithmic_) {
    low = std::min(low, 0.0);
    high = std::max(high, 0.0);
  }
  is_logarithmic_ ? choose_logarithmic(low, high) : choose_linear(low, high);
}

void Axis::choose_linear(double low, double high) {
  if (!(high > low)) {
    const double room = low == 0 ? 1 : std::abs(low) / 2;
    low -= room;
    high += room;
  }
  const double spacing = round_spacing((high - low) / kIntervals);
  const auto first = std::floor(low / spacing + kSlack);
  const auto last = std::ceil(high / spacing - kSlack);
  for (double i = first; i <= last; ++i) ticks_.push_back(i * spacing);
}

/// Ticks at 1, 2 and 5 of each decade; over many decades at 1 alone.
void Axis::choose_logarithmic(double low, double high) {
  const double first = std::floor(std::log10(low) + kSlack);
  const double last = std::ceil(std::log10(high) - kSlack);
  for (double decade = first; decade <= last; ++decade)
    for (const double factor : {1.0, 2.0, 5.0})
      if (factor == 1 || last - first <= 3) ticks_.push_back(factor * std::pow(10, decade));
  // The ends are the tick at or below the smallest value and that at or above the largest.
  const auto above = std::find_if(ticks_.begin(), ticks_.end(),
                                  [&](double tick) { return tick >= high * (1 - kSlack); });
  if (above != ticks_.end()) ticks_.erase(above + 1, ticks_.end());
  const auto below = std::find_if(ticks_.begin(), ticks_.end(),
                                  [&](double tick) { return tick > low * (1 + kSlack); });
  if (below > ticks_.begin() + 1) ticks_.erase(ticks_.begin(), below - 1);
}

double Axis::position(double value) const {
  const auto at = [&](double v) { return is_logarithmic_ ? std::log(v) : v; };
  return (at(value) - at(ticks_.front())) / (at(ticks_.back()) - at(ticks_.front()));
}

std::string Axis::text(double tick) {
  if (std::abs(tick) >= 1e6) return fmt::format("{:.4g}M", tick / 1e6);
  if (std::abs(tick) >= 1e4) return fmt::format("{:.4g}k", tick / 1e3);
  return fmt::format("{:.4g}", tick);
}

Rgb8 series_colour(std::size_t index) {
  static constexpr std::array<Rgb8, 8> kColours{{{36, 104, 200},
                                                 {214, 84, 20},
                                                 {0, 140, 104},
                                                 {168, 84, 176},
                                                 {196, 148, 0},
                                                 {84, 168, 216},
                                                 {150, 40, 60},
                                                 {120, 126, 134}}};
  return kColours[index % kColours.size()];
}

}  // namespace saccade
