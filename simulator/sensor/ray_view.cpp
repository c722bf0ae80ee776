#include "simulator/sensor/ray_view.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace saccade {
namespace {

/// A path may leave its cell by this much and count as within: the divisions at texel borders are
/// that exact [texel].
constexpr double kOverhang = 1e-3;

struct Interval {
  double low, high;

  void include(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
};

Interval product(const Interval& a, const Interval& b) {
  Interval result{a.low * b.low, a.low * b.low};
  result.include(a.low * b.high);
  result.include(a.high * b.low);
  result.include(a.high * b.high);
  return result;
}

/// So far behind a border it is divided [texel]: a signal that only touches a threshold in the very
/// corner of its course, where two texels are alike, does not depend on the last bit.
constexpr double kPast = 1e-5;

/// One coordinate of the cubic over a stretch: u (1 - u)^2 and u^2 (u - 1) weigh the differences of
/// the ends' rates from the chord's.
struct Track {
  double from, to;
  double chord_rate, from_excess, to_excess;  ///< [1/s]
  double length_s;

  Track(double from_value, double from_rate, double to_value, double to_rate, double seconds)
      : from(from_value),
        to(to_value),
        chord_rate((to_value - from_value) / seconds),
        from_excess(from_rate - chord_rate),
        to_excess(to_rate - chord_rate),
        length_s(seconds) {}

  [[nodiscard]] double stray() const {
    return 4.0 / 27 * length_s * (std::abs(from_excess) + std::abs(to_excess));
  }

  [[nodiscard]] Interval values() const {
    return {std::min(from, to) - stray(), std::max(from, to) + stray()};
  }

  /// The weights' own derivatives stay within [-1/3, 1].
  [[nodiscard]] Interval rates() const {
    const auto reach = [](double excess) {
      return Interval{std::min(excess, -excess / 3), std::max(excess, -excess / 3)};
    };
    const Interval a = reach(from_excess);
    const Interval b = reach(to_excess);
    return {chord_rate + a.low + b.low, chord_rate + a.high + b.high};
  }

  [[nodiscard]] double at(double u) const {
    return from + u * (to - from) +
           length_s * u * (1 - u) * ((1 - u) * from_excess - u * to_excess);
  }

  [[nodiscard]] double rate_at(double u) const {
    return chord_rate + (1 - u) * (1 - 3 * u) * from_excess + u * (3 * u - 2) * to_excess;
  }
};

Track x_track(const RayView& from, const RayView& to, double length_s) {
  return {from.look.x, from.x_rate, to.look.x, to.x_rate, length_s};
}

Track y_track(const RayView& from, const RayView& to, double length_s) {
  return {from.look.y, from.y_rate, to.look.y, to.y_rate, length_s};
}

/// A cell of a texture with the part of it that a path may touch, from its upper left texel.
struct Cell {
  std::array<double, 4> corners;
  Interval x, y;  ///< within [0, 1] but for the overhang

  [[nodiscard]] double value(double fx, double fy) const {
    const double top = corners[0] + fx * (corners[1] - corners[0]);
    const double bottom = corners[2] + fx * (corners[3] - corners[2]);
    return top + fy * (bottom - top);
  }
  [[nodiscard]] double slope_x(double fy) const {
    const double top = corners[1] - corners[0];
    return top + fy * (corners[3] - corners[2] - top);
  }
  [[nodiscard]] double slope_y(double fx) const {
    const double left = corners[2] - corners[0];
    return left + fx * (corners[3] - corners[1] - left);
  }

  /// A bilinear function has its extremes over a rectangle at the corners.
  [[nodiscard]] Interval values() const {
    Interval range{value(x.low, y.low), value(x.low, y.low)};
    range.include(value(x.low, y.high));
    range.include(value(x.high, y.low));
    range.include(value(x.high, y.high));
    return range;
  }
  [[nodiscard]] Interval slopes_x() const {
    Interval range{slope_x(y.low), slope_x(y.low)};
    range.include(slope_x(y.high));
    return range;
  }
  [[nodiscard]] Interval slopes_y() const {
    Interval range{slope_y(x.low), slope_y(x.low)};
    range.include(slope_y(x.high));
    return range;
  }
};

struct CellIndex {
  double i, j;
};

CellIndex middle_cell(const Track& x, const Track& y) {
  return {std::floor(0.5 * (x.from + x.to)), std::floor(0.5 * (y.from + y.to))};
}

bool is_within(const Interval& range, double index) {
  return range.low >= index - kOverhang && range.high <= index + 1 + kOverhang;
}

Cell cell_of(const Texture& texture, const CellIndex& index, const Interval& x, const Interval& y) {
  const std::array<float, 4> texels =
      texture.cell(static_cast<std::int64_t>(index.i), static_cast<std::int64_t>(index.j));
  return {{texels[0], texels[1], texels[2], texels[3]},
          {x.low - index.i, x.high - index.i},
          {y.low - index.j, y.high - index.j}};
}

/// Multiplies the albedo's range by the light. Between both ends the irradiance is taken to stay
/// near their line: shadows' edges are jumps and not foreseen.
RadianceRange illuminated(const Interval& values, const Interval& rates, const RayView& from,
                          const RayView& to, double length_s) {
  const double factor = from.look.texture != nullptr ? from.look.factor : 1;
  const double a = factor * from.look.irradiance;
  const double b = factor * to.look.irradiance;
  if (a == b) return {a * values.low, a * values.high, a * rates.low, a * rates.high};
  const double slack = 0.25 * std::abs(b - a);
  const Interval light{std::min(a, b) - slack, std::max(a, b) + slack};
  const Interval light_rate{(b - a - 2 * slack) / length_s, (b - a + 2 * slack) / length_s};
  const Interval radiance = product(values, light);
  const Interval first = product(rates, light);
  const Interval second = product(values, light_rate);
  return {radiance.low, radiance.high, first.low + second.low, first.high + second.high};
}

}  // namespace

double log_intensity(double radiance, double log_eps) { return std::log(log_eps + radiance); }

double RadianceRange::log_error(double log_eps, double length_s) const {
  const double least = log_eps + std::max(low, 0.0);
  const double most = log_eps + high;
  const double spread = std::log(most / least);
  const double fastest = rate_high / (rate_high > 0 ? least : most);
  const double slowest = rate_low / (rate_low > 0 ? most : least);
  const double straying = 0.25 * (fastest - slowest) * length_s;
  return straying < spread ? straying : spread;  // also when one is not a number
}

RadianceRange radiance_range(const RayView& from, const RayView& to, double length_s) {
  if (from.look.texture != to.look.texture) return {};
  const Track x = x_track(from, to, length_s);
  if (from.look.texture == nullptr) return illuminated(x.values(), x.rates(), from, to, length_s);
  const Track y = y_track(from, to, length_s);
  const Interval across = x.values();
  const Interval down = y.values();
  if (!(across.high - across.low < 1e6 && down.high - down.low < 1e6)) return {};
  const CellIndex index = middle_cell(x, y);
  const Texture& texture = *from.look.texture;
  if (is_within(across, index.i) && is_within(down, index.j)) {
    const Cell cell = cell_of(texture, index, across, down);
    const Interval along_x = product(cell.slopes_x(), x.rates());
    const Interval along_y = product(cell.slopes_y(), y.rates());
    return illuminated(cell.values(), {along_x.low + along_y.low, along_x.high + along_y.high},
                       from, to, length_s);
  }
  const TexelRange range = texture.range({across.low, across.high, down.low, down.high});
  return illuminated({range.low, range.high}, {-RadianceRange::kUnknown, RadianceRange::kUnknown},
                     from, to, length_s);
}

RayView interpolate(const RayView& from, const RayView& to, double length_s, double fraction) {
  const Track x = x_track(from, to, length_s);
  const Track y = y_track(from, to, length_s);
  RayView view = from;
  view.look.x = x.at(fraction);
  view.look.y = y.at(fraction);
  view.x_rate = x.rate_at(fraction);
  view.y_rate = y.rate_at(fraction);
  view.look.distance += fraction * (to.look.distance - from.look.distance);
  view.look.irradiance += fraction * (to.look.irradiance - from.look.irradiance);
  return view;
}

bool is_straight(const RayView& from, const RayView& to, double length_s) {
  constexpr double kStraight = 0.02;  // texel; the cubic's own error is orders of magnitude smaller
  return x_track(from, to, length_s).stray() + y_track(from, to, length_s).stray() < kStraight;
}

double dividing_fraction(const RayView& from, const RayView& to, double length_s) {
  constexpr double kNearest = 0.02;
  if (from.look.texture == nullptr || from.look.texture != to.look.texture) return 0.5;
  const Track x = x_track(from, to, length_s);
  const Track y = y_track(from, to, length_s);
  const CellIndex index = middle_cell(x, y);
  double best = -1;
  const auto consider = [&](const Track& track, double border) {
    const double past = border + std::copysign(kPast, track.to - track.from);
    double u = (past - track.from) / (track.to - track.from);
    if (!(u > 0 && u < 1)) return;
    u += (past - track.at(u)) / (track.rate_at(u) * length_s);
    if (u > kNearest && u < 1 - kNearest && std::abs(u - 0.5) < std::abs(best - 0.5)) best = u;
  };
  consider(x, index.i);
  consider(x, index.i + 1);
  consider(y, index.j);
  consider(y, index.j + 1);
  if (best > 0) return best;
  if (!is_within(x.values(), index.i) || !is_within(y.values(), index.j)) return 0.5;
  const Cell cell = cell_of(*from.look.texture, index, {x.from, x.to}, {y.from, y.to});
  const double a = cell.slope_x(cell.y.low) * from.x_rate + cell.slope_y(cell.x.low) * from.y_rate;
  const double b = cell.slope_x(cell.y.high) * to.x_rate + cell.slope_y(cell.x.high) * to.y_rate;
  const double u = a / (a - b);
  return u > kNearest && u < 1 - kNearest ? u : 0.5;
}

}  // namespace saccade
