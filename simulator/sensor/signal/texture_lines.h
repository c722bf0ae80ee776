#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "simulator/sensor/signal/path_cells.h"
#include "simulator/sensor/signal/texel_trajectory.h"

namespace saccade {

/// How far ln(eps + I) may depart from a straight line, and how far that may rise or fall.
struct LineLimits {
  double error;   ///< [log units]
  double change;  ///< [log units], small
};

/// Goes along the texels of a path, whose values are bilinear from border to border, in lines as
/// long as some limits allow: over many cells where the texture is smooth, over parts of one where
/// it is not.
class TextureLines {
 public:
  /// From `u` on; all arguments outlive it. The radiance is `factor` times the texture, and
  /// `log_eps` as in ln(eps + I).
  TextureLines(const TexelTrajectory& path, const PathCells& cells, double factor, double log_eps,
               const LineLimits& limits, double u)
      : path_(path),
        cells_(cells),
        factor_(factor),
        log_eps_(log_eps),
        // Where a radiance is a line, its logarithm departs from one by an eighth of the square of
        // the change, and by more than its radiance does, relatively, where that is least.
        error_((limits.error - 0.125 * limits.change * limits.change) * (1 - limits.change)),
        change_(limits.change * (1 - 0.5 * limits.change)) {
    find_knots();
    go_to(u);
  }

  [[nodiscard]] double u() const { return u_; }
  /// The radiance there.
  [[nodiscard]] double radiance() const { return value_; }
  void go_to(double u) {
    u_ = u;
    cell_ = cells_.at(u);
    value_ = value_at(cell_, u);
  }

  /// How far the path goes on, up to `to`, with radiances within the open interval `band` for
  /// certain, and the least of those.
  struct Run {
    double end;
    double least;
  };
  [[nodiscard]] Run run_within(const Interval& band, double to) const {
    const Interval texels{band.low / factor_, band.high / factor_};
    Run run{u_, std::numeric_limits<double>::infinity()};
    for (int cell = cell_; cell < cells_.count() && run.end < to; ++cell) {
      const int outside = cells_.next_outside(cell, texels);
      for (; cell < outside; ++cell) {
        run.least = std::min(run.least, factor_ * cells_.low(cell));
        run.end = std::min(cells_.end(cell), to);
      }
      if (cell == cells_.count() || run.end >= to) break;
      // A cell with a texel outside: the path may leave the band in its midst, or not at all.
      const Run part = run_within_cell(cell, run.end, band, to);
      run.least = std::min(run.least, part.least);
      run.end = part.end;
      if (run.end < std::min(cells_.end(cell), to)) break;
    }
    return run;
  }

  /// Goes on to the end of a line: `to` at most, and no less than `least` further, unless `to` is
  /// nearer.
  void advance(double to, double least) {
    const double scale = log_eps_ + value_;
    const double reach = change_ * scale;
    const double error = error_ * scale;
    Knot end = knot(cell_, u_, to);
    if (!(std::abs(end.value - value_) <= reach && end.straying <= error)) {
      arrive(part_of_cell(end, reach, error, least));
      return;
    }
    // The slopes of lines that pass all knots so far near enough; the rest is for what strays
    // between two knots.
    const double near = 0.5 * error;
    Interval slopes{-std::numeric_limits<double>::infinity(),
                    std::numeric_limits<double>::infinity()};
    while (end.straying <= near && end.u < to && cell_ + 1 < cells_.count()) {
      const double per_length = 1 / (end.u - u_);
      slopes.low = std::max(slopes.low, (end.value - value_ - near) * per_length);
      slopes.high = std::min(slopes.high, (end.value - value_ + near) * per_length);
      const Knot next = knot(cell_ + 1, end.u, to);
      const double rise = next.value - value_;
      const double slope = rise / (next.u - u_);
      if (!(std::abs(rise) <= reach && next.straying <= near && slope >= slopes.low &&
            slope <= slopes.high))
        break;
      ++cell_;
      end = next;
    }
    arrive(end);
  }

 private:
  /// Where the path leaves a cell or ends in it, and how far it strays from the line between there
  /// and where it came into the cell or began.
  struct Knot {
    double u, value, straying;
  };

  /// Of the part of a cell from `from` on.
  [[nodiscard]] Knot knot(int cell, double from, double to) const {
    const auto k = static_cast<std::size_t>(cell);
    const double end = std::min(cells_.end(cell), to);
    const double length = end - from;
    return {end, end < cells_.end(cell) ? value_at(cell, end) : values_[k],
            bends_[k] * length * length};
  }

  /// The first part of what is left of a cell up to `end` that is within the limits.
  [[nodiscard]] Knot part_of_cell(const Knot& end, double reach, double error, double least) const {
    constexpr double kCautious = 0.95;
    const double left = end.u - u_;
    const double rise = std::abs(end.value - value_);
    double length = left * std::min(kCautious * reach / std::max(rise, reach),
                                    std::sqrt(error / std::max(end.straying, error)));
    Knot part = knot(cell_, u_, u_ + length);
    while (!(std::abs(part.value - value_) <= reach) && length > least) {
      length *= 0.5;
      part = knot(cell_, u_, u_ + length);
    }
    return length > least ? part : knot(cell_, u_, std::min(u_ + least, end.u));
  }

  void arrive(const Knot& end) {
    u_ = end.u;
    value_ = end.value;
    if (cell_ + 1 < cells_.count() && cells_.end(cell_) <= u_) ++cell_;
  }

  [[nodiscard]] double value_at(int cell, double u) const {
    const Place place = place_at(cell, path_.x.at(u), path_.y.at(u));
    return factor_ * Bilinear(cells_.corners(cell)).at(place.x, place.y);
  }

  /// Within a cell, 0 to 1. Where the path leaves it is known to a small part of a texel alone, and
  /// what its texels give beyond it may be less than nothing.
  struct Place {
    double x, y;
  };
  [[nodiscard]] Place place_at(int cell, double x, double y) const {
    return {std::clamp(x - static_cast<double>(cells_.i(cell)), 0.0, 1.0),
            std::clamp(y - static_cast<double>(cells_.j(cell)), 0.0, 1.0)};
  }

  struct Bilinear {
    double corner, along_x, along_y, twist;

    explicit Bilinear(const std::array<float, 4>& corners)
        : corner(corners[0]),
          along_x(corners[1] - corners[0]),
          along_y(corners[2] - corners[0]),
          twist(corners[3] - corners[2] - along_x) {}
    /// Of the changes per texel, in any direction.
    [[nodiscard]] double steepest() const {
      return std::abs(along_x) + std::abs(along_y) + 2 * std::abs(twist);
    }
    [[nodiscard]] double at(double x, double y) const {
      return corner + x * along_x + y * (along_y + twist * x);
    }
  };

  /// As run_within(), in a cell from `from` on. Along the chord the radiance is a parabola.
  [[nodiscard]] Run run_within_cell(int cell, double from, const Interval& band, double to) const {
    const double end = std::min(cells_.end(cell), to);
    const double length = end - from;
    const Bilinear texels(cells_.corners(cell));
    const Place first = place_at(cell, path_.x.at(from), path_.y.at(from));
    const Place last = place_at(cell, path_.x.at(end), path_.y.at(end));
    const double p = last.x - first.x;
    const double q = last.y - first.y;
    const Parabola along{factor_ * texels.at(first.x, first.y),
                         factor_ * (p * (texels.along_x + texels.twist * first.y) +
                                    q * (texels.along_y + texels.twist * first.x)),
                         factor_ * texels.twist * p * q};
    const double margin = factor_ * path_bending() * texels.steepest() * length * length;
    const double low = band.low + margin;
    const double high = band.high - margin;
    if (!(along.start > low && along.start < high)) return {from, along.start};
    const double part = std::min({1.0, along.first_at(low), along.first_at(high)});
    return {part < 1 ? from + part * length : end, along.least_up_to(part) - margin};
  }

  /// start + rise s + bend s^2.
  struct Parabola {
    double start, rise, bend;

    [[nodiscard]] double at(double s) const { return start + s * (rise + s * bend); }
    /// The least s > 0 at which it has a value that it does not start with; infinite where it never
    /// has.
    [[nodiscard]] double first_at(double value) const {
      constexpr double kNever = std::numeric_limits<double>::infinity();
      const double missing = start - value;
      const double discriminant = rise * rise - 4 * bend * missing;
      if (!(discriminant >= 0)) return kNever;
      const double sum = -0.5 * (rise + std::copysign(std::sqrt(discriminant), rise));
      const double one = sum / bend;
      const double other = missing / sum;
      return std::min(one > 0 ? one : kNever, other > 0 ? other : kNever);
    }
    [[nodiscard]] double least_up_to(double s) const {
      const double vertex = -0.5 * rise / bend;
      const double ends = std::min(start, at(s));
      return bend > 0 && vertex > 0 && vertex < s ? at(vertex) : ends;
    }
  };

  /// How far the path strays from a chord, by the square of its length [texel].
  [[nodiscard]] double path_bending() const {
    return 0.125 * std::max(path_.x.second_derivative_bound(), path_.y.second_derivative_bound());
  }

  /// Of all cells, as if the path went all the way through them.
  void find_knots() {
    const double bending = path_bending();
    double u0 = cells_.start();
    double x0 = path_.x.at(u0);
    double y0 = path_.y.at(u0);
    for (int cell = 0; cell < cells_.count(); ++cell) {
      const auto k = static_cast<std::size_t>(cell);
      const double u1 = cells_.end(cell);
      const double x1 = path_.x.at(u1);
      const double y1 = path_.y.at(u1);
      const Bilinear texels(cells_.corners(cell));
      const Place place = place_at(cell, x1, y1);
      values_[k] = factor_ * texels.at(place.x, place.y);
      // Along the chord the bilinear function is a parabola; the path departs from the chord.
      const double length = std::max(u1 - u0, kShortest);
      const double bend = 0.25 * std::abs(texels.twist * (x1 - x0) * (y1 - y0));
      bends_[k] = factor_ * (bend / (length * length) + bending * texels.steepest());
      u0 = u1;
      x0 = x1;
      y0 = y1;
    }
  }

  /// A cell of no length does not bend.
  static constexpr double kShortest = 1e-9;

  const TexelTrajectory& path_;
  const PathCells& cells_;
  double factor_;
  double log_eps_;
  double error_;                                ///< relative to eps + I
  double change_;                               ///< likewise
  std::array<double, PathCells::kMax> values_;  ///< at the ends of the cells
  std::array<double, PathCells::kMax> bends_;   ///< how far a line strays in them, by its length^2
  double u_ = 0;
  int cell_ = 0;  ///< in which the path goes on from u_
  double value_ = 0;
};

}  // namespace saccade
