#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "simulator/sensor/signal/path_cells.h"
#include "simulator/sensor/signal/texel_borders.h"
#include "simulator/sensor/signal/texel_trajectory.h"

namespace saccade {

/// The texture along a path while that stays within one cell.
class CellSegment {
 public:
  CellSegment(const TexelTrajectory& path, const std::array<float, 4>& corners, std::int64_t i,
              std::int64_t j, double u0, double u1)
      : path_(path),
        corner_(corners[0]),
        along_x_(corners[1] - corners[0]),
        along_y_(corners[2] - corners[0]),
        twist_(corners[3] - corners[2] - along_x_),
        i_(static_cast<double>(i)),
        j_(static_cast<double>(j)),
        u0_(u0),
        u1_(u1) {}

  [[nodiscard]] double from() const { return u0_; }
  [[nodiscard]] double to() const { return u1_; }

  [[nodiscard]] double value(double u) const {
    return value_at(path_.x.at(u) - i_, path_.y.at(u) - j_);
  }
  [[nodiscard]] double slope(double u) const {
    return (along_x_ + twist_ * (path_.y.at(u) - j_)) * path_.x.slope_at(u) +
           (along_y_ + twist_ * (path_.x.at(u) - i_)) * path_.y.slope_at(u);
  }

  /// Bounds, and whether the values rise or fall throughout. Along the chord the bilinear function
  /// is a parabola; the path departs less than `chord_error` texels from it.
  struct Bounds {
    double first, last;
    Interval values;
    bool is_monotone;
  };
  [[nodiscard]] Bounds bounds(double chord_error) const {
    const double x0 = path_.x.at(u0_) - i_;
    const double y0 = path_.y.at(u0_) - j_;
    const double p = path_.x.at(u1_) - i_ - x0;
    const double q = path_.y.at(u1_) - j_ - y0;
    const double steepest = std::abs(along_x_) + std::abs(along_y_) + std::abs(twist_);
    const double margin = chord_error * steepest;
    const double rise = p * (along_x_ + twist_ * y0) + q * (along_y_ + twist_ * x0);
    const double bend = twist_ * p * q;
    const double first = value_at(x0, y0);
    const double last = first + rise + bend;
    Interval values{std::min(first, last), std::max(first, last)};
    const double extremum = -0.5 * rise;  // times the bend
    if (extremum * bend > 0 && std::abs(extremum) < std::abs(bend))
      values.include(first - extremum * extremum / bend);
    // Both ends' slopes, beyond what the path's departure can change.
    const double end_rise = rise + 2 * bend;
    const bool is_monotone =
        rise * end_rise > 0 && std::min(std::abs(rise), std::abs(end_rise)) > 8 * margin;
    return {first, last, {values.low - margin, values.high + margin}, is_monotone};
  }

 private:
  [[nodiscard]] double value_at(double x, double y) const {
    return corner_ + x * along_x_ + y * (along_y_ + twist_ * x);
  }

  const TexelTrajectory& path_;
  double corner_, along_x_, along_y_, twist_;
  double i_, j_;
  double u0_, u1_;
};

/// A path over a texture, cell by cell.
class TexelTraversal {
 public:
  /// Both outlive the traversal.
  TexelTraversal(const Texture& texture, const TexelTrajectory& path)
      : TexelTraversal(texture, path, 0, 1) {}

  /// Goes along a part of the path and calls `visit(segment, bounds)` for each cell in which the
  /// texture may leave the open interval `band`, until that returns false: then false. Where the
  /// path may turn back over a texel's border, in halves, and at last `search(u0, u1)`.
  template <class Visit, class Search>
  bool traverse(double from, double to, const Interval& band, const Visit& visit,
                const Search& search) const {
    if (is_monotone()) return traverse_monotone(from, to, band, visit);
    if (to - from < kShortest) return search(from, to);
    const double middle = 0.5 * (from + to);
    return TexelTraversal(texture_, path_, from, middle)
               .traverse(from, middle, band, visit, search) &&
           TexelTraversal(texture_, path_, middle, to).traverse(middle, to, band, visit, search);
  }

  /// use(cells, u0, u1) with the parts of the path from `from` to `to`, in order, through which it
  /// goes without turning back over a texel's border; search(u0, u1) where that is not known.
  template <class Use, class Search>
  void visit_parts(double from, double to, const Use& use, const Search& search) const {
    if (is_monotone()) return use(PathCells(texture_, across_, down_), from, to);
    if (to - from < kShortest) return search(from, to);
    const double middle = 0.5 * (from + to);
    TexelTraversal(texture_, path_, from, middle).visit_parts(from, middle, use, search);
    TexelTraversal(texture_, path_, middle, to).visit_parts(middle, to, use, search);
  }

 private:
  static constexpr double kRounding_texel = 1e-3;
  static constexpr double kShortest = 1.0 / 64;

  TexelTraversal(const Texture& texture, const TexelTrajectory& path, double from, double to)
      : texture_(texture),
        path_(path),
        across_(path.x, from, to),
        down_(path.y, from, to),
        max_chord_error_(
            0.125 * std::max(path.x.second_derivative_bound(), path.y.second_derivative_bound())) {}

  [[nodiscard]] bool is_monotone() const { return across_.is_monotone() && down_.is_monotone(); }

  template <class Visit>
  bool traverse_monotone(double from, double to, const Interval& band, const Visit& visit) const {
    int right = across_.passed(from);
    int below = down_.passed(from);
    for (double u0 = from; u0 < to;) {
      const bool is_right = across_.crossing(right) <= down_.crossing(below);
      const double u1 = std::min(is_right ? across_.crossing(right) : down_.crossing(below), to);
      const std::array<float, 4> corners = texture_.cell(across_.index(right), down_.index(below));
      const float low =
          std::min(std::min(corners[0], corners[1]), std::min(corners[2], corners[3]));
      const float high =
          std::max(std::max(corners[0], corners[1]), std::max(corners[2], corners[3]));
      if (!(low > band.low && high < band.high)) {
        const CellSegment segment(path_, corners, across_.index(right), down_.index(below), u0, u1);
        const CellSegment::Bounds bounds =
            segment.bounds(max_chord_error_ * (u1 - u0) * (u1 - u0) + kRounding_texel);
        if (!(bounds.values.low > band.low && bounds.values.high < band.high) &&
            !visit(segment, bounds))
          return false;
      }
      right += is_right ? 1 : 0;
      below += is_right ? 0 : 1;
      u0 = u1;
    }
    return true;
  }

  const Texture& texture_;
  const TexelTrajectory& path_;
  TexelBorders across_, down_;
  double max_chord_error_;
};

}  // namespace saccade
