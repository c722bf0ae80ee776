#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "simulator/sensor/signal/ray_sample.h"

namespace saccade {

/// A path may leave its cell by this much and count as within: the divisions at texel borders are
/// that exact [texel].
constexpr double kOverhang = 1e-3;

/// Paths that depart by less than this from their chord are as good as their cubics, whose own
/// error is orders of magnitude smaller.
constexpr double kStraight_texel = 0.005;

struct Interval {
  double low, high;

  void include(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
};

inline Interval product(const Interval& a, const Interval& b) {
  Interval result{a.low * b.low, a.low * b.low};
  result.include(a.low * b.high);
  result.include(a.high * b.low);
  result.include(a.high * b.high);
  return result;
}

/// One coordinate of the cubic over an interval, u = 0..1: u (1 - u)^2 and u^2 (u - 1) weigh the
/// differences of the ends' slopes from the chord's.
struct HermiteCoordinate {
  double from, to;
  double chord;                   ///< [texel]
  double from_excess, to_excess;  ///< of the slopes over u [texel]
  double length_s;

  HermiteCoordinate(double from_value, double from_rate, double to_value, double to_rate,
                    double seconds)
      : from(from_value),
        to(to_value),
        chord(to_value - from_value),
        from_excess(from_rate * seconds - chord),
        to_excess(to_rate * seconds - chord),
        length_s(seconds) {}

  [[nodiscard]] double chord_error() const {
    return 4.0 / 27 * (std::abs(from_excess) + std::abs(to_excess));
  }

  [[nodiscard]] Interval values() const {
    return {std::min(from, to) - chord_error(), std::max(from, to) + chord_error()};
  }

  /// Over u. The weights' own derivatives stay within [-1/3, 1].
  [[nodiscard]] Interval slopes() const {
    const auto reach = [](double excess) {
      return Interval{std::min(excess, -excess / 3), std::max(excess, -excess / 3)};
    };
    const Interval a = reach(from_excess);
    const Interval b = reach(to_excess);
    return {chord + a.low + b.low, chord + a.high + b.high};
  }
  /// The same over time [1/s].
  [[nodiscard]] Interval rates() const {
    const Interval slope = slopes();
    return {slope.low / length_s, slope.high / length_s};
  }

  [[nodiscard]] double at(double u) const {
    return from + u * (chord + (1 - u) * ((1 - u) * from_excess - u * to_excess));
  }

  [[nodiscard]] double slope_at(double u) const {
    return chord + (1 - u) * (1 - 3 * u) * from_excess + u * (3 * u - 2) * to_excess;
  }
  [[nodiscard]] double rate_at(double u) const { return slope_at(u) / length_s; }
};

inline HermiteCoordinate x_coordinate(const RaySample& from, const RaySample& to, double length_s) {
  return {from.surface.x, from.x_rate, to.surface.x, to.x_rate, length_s};
}

inline HermiteCoordinate y_coordinate(const RaySample& from, const RaySample& to, double length_s) {
  return {from.surface.y, from.y_rate, to.surface.y, to.y_rate, length_s};
}

/// The level of the texture's pyramid. Its path may have a kink, where the longer side of the
/// footprint changes or reaches a texel.
inline HermiteCoordinate level_coordinate(const RaySample& from, const RaySample& to,
                                          double length_s) {
  return {from.surface.level, from.level_rate, to.surface.level, to.level_rate, length_s};
}

/// A kinked path turns at the meeting of both ends' tangents, at most a quarter of the sum of their
/// differences from the chord's rate away from it.
inline Interval level_values(const HermiteCoordinate& level) {
  const double chord_error = 27.0 / 16 * level.chord_error();
  return {std::max(std::min(level.from, level.to) - chord_error, 0.0),
          std::max(level.from, level.to) + chord_error};
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

inline CellIndex middle_cell(const HermiteCoordinate& x, const HermiteCoordinate& y) {
  return {std::floor(0.5 * (x.from + x.to)), std::floor(0.5 * (y.from + y.to))};
}

inline bool is_within_cell(const Interval& range, double index) {
  return range.low >= index - kOverhang && range.high <= index + 1 + kOverhang;
}

inline Cell cell_of(const Texture& texture, const CellIndex& index, const Interval& x,
                    const Interval& y) {
  const std::array<float, 4> texels =
      texture.cell(static_cast<std::int64_t>(index.i), static_cast<std::int64_t>(index.j));
  return {{texels[0], texels[1], texels[2], texels[3]},
          {x.low - index.i, x.high - index.i},
          {y.low - index.j, y.high - index.j}};
}

/// Where to divide an interval: the border of a texel or of a level that is nearest to the middle.
class SplitPoint {
 public:
  static constexpr double kNearest = 0.02;  ///< to an end
  /// So far behind a border it is divided [texel]: a signal that only touches a threshold in the
  /// very corner of its path, where two texels are alike, does not depend on the last bit.
  static constexpr double kPast = 1e-5;

  /// The time at which `track` is past `border`, one step of Newton's method from the chord.
  void consider(const HermiteCoordinate& track, double border) {
    const double past = border + std::copysign(kPast, track.chord);
    double u = (past - track.from) / track.chord;
    if (!(u > 0 && u < 1)) return;
    u += (past - track.at(u)) / track.slope_at(u);
    if (u > kNearest && u < 1 - kNearest && std::abs(u - 0.5) < std::abs(best_ - 0.5)) best_ = u;
  }

  /// The borders of the cell in the middle.
  void consider_cell(const HermiteCoordinate& x, const HermiteCoordinate& y) {
    const CellIndex index = middle_cell(x, y);
    consider(x, index.i);
    consider(x, index.i + 1);
    consider(y, index.j);
    consider(y, index.j + 1);
  }

  [[nodiscard]] bool found() const { return best_ > 0; }
  [[nodiscard]] double fraction() const { return best_; }

  /// `fraction` where it is inside, else the middle.
  [[nodiscard]] static double inside(double fraction) {
    return fraction > kNearest && fraction < 1 - kNearest ? fraction : 0.5;
  }

 private:
  double best_ = -1;
};

/// Fraction of an interval within one cell at which the radiance turns; the middle if it does not
/// or the path leaves the cell.
inline double extremum_in_cell(const Texture& texture, const HermiteCoordinate& x,
                               const HermiteCoordinate& y) {
  const CellIndex index = middle_cell(x, y);
  if (!is_within_cell(x.values(), index.i) || !is_within_cell(y.values(), index.j)) return 0.5;
  const Cell cell = cell_of(texture, index, {x.from, x.to}, {y.from, y.to});
  const double a =
      cell.slope_x(cell.y.low) * x.rate_at(0) + cell.slope_y(cell.x.low) * y.rate_at(0);
  const double b =
      cell.slope_x(cell.y.high) * x.rate_at(1) + cell.slope_y(cell.x.high) * y.rate_at(1);
  return SplitPoint::inside(a / (a - b));
}

}  // namespace saccade
