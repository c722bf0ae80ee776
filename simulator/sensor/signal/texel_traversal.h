#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "simulator/sensor/signal/texel_trajectory.h"

namespace saccade {

/// The borders between texels that one coordinate of a path crosses on a part of it, in order. All
/// of them are found at once, in whole lanes for the compiler to vectorise.
class TexelBorders {
 public:
  explicit TexelBorders(const TrajectoryCoordinate& track)
      : TexelBorders(track, CoordinateBounds(track), 0, 1) {}
  TexelBorders(const TrajectoryCoordinate& track, double u0, double u1)
      : TexelBorders(track, CoordinateBounds(track, u0, u1), u0, u1) {}

  /// Whether the coordinate never turns back over a border, nor crosses too many.
  [[nodiscard]] bool is_monotone() const { return is_monotone_; }
  /// The texel that it is past after `k` crossings.
  [[nodiscard]] std::int64_t index(int k) const { return first_ + step_ * k; }
  /// Where it leaves that, at the latest at the end of the part.
  [[nodiscard]] double crossing(int k) const { return crossings_[static_cast<std::size_t>(k)]; }
  /// The number of crossings up to `u`.
  [[nodiscard]] int passed(double u) const {
    int k = 0;
    while (k < count_ && crossing(k) <= u) ++k;
    return k;
  }

 private:
  static constexpr int kMax = 16;
  static constexpr int kLanes = 8;

  TexelBorders(const TrajectoryCoordinate& track, const CoordinateBounds& part, double u0,
               double u1) {
    step_ = part.slopes.low > 0 ? 1 : part.slopes.high < 0 ? -1 : 0;
    const double start = std::floor(part.from);
    first_ = static_cast<std::int64_t>(start);
    if (step_ != 0)
      count_ = static_cast<int>(std::min(std::abs(std::floor(part.to) - start), kMax + 1.0));
    is_monotone_ = step_ != 0 ? count_ <= kMax : is_within_cell(part.values, start);
    if (is_monotone_ && count_ > 0) is_monotone_ = find(track, part, u0, u1);
    crossings_[is_monotone_ ? static_cast<std::size_t>(count_) : 0] = u1;
  }

  /// The inverse cubic of the part's ends and one step of Newton's method; false where that is not
  /// enough. Where the path is nearly even, it is: the cubic is off by less than a hundredth of the
  /// excess cubed.
  bool find(const TrajectoryCoordinate& track, const CoordinateBounds& part, double u0, double u1) {
    constexpr double kExact_texel = 1e-4;
    constexpr double kEven = 0.25;
    constexpr double kFlat_texel = 0.01;
    const double length = u1 - u0;
    const double chord = part.to - part.from;
    const double from_excess = chord / (part.from_slope * length) - 1;
    const double to_excess = chord / (part.to_slope * length) - 1;
    const bool is_even = std::max(std::abs(from_excess), std::abs(to_excess)) < kEven &&
                         std::abs(track.quartic()) < kFlat_texel;
    const double per_texel = 1 / chord;
    const auto border = static_cast<double>(step_ > 0 ? first_ + 1 : first_);
    for (int k = 0; k < count_; k += kLanes)
      for (int lane = 0; lane < kLanes; ++lane) {
        const double value = border + step_ * (k + lane);
        const double s = (value - part.from) * per_texel;
        const double r = 1 - s;
        const double speed = 1 + r * (1 - 3 * s) * from_excess + s * (3 * s - 2) * to_excess;
        double u = u0 + length * s * (1 + r * (r * from_excess - s * to_excess));
        u += (value - track.at(u)) * (speed * length * per_texel);
        u = u > u0 ? u : u0;
        crossings_[static_cast<std::size_t>(k + lane)] = u < u1 ? u : u1;
      }
    for (int k = 0; k < count_ && !is_even; ++k)
      if (!(std::abs(border + step_ * k - track.at(crossing(k))) <= kExact_texel)) return false;
    return true;
  }

  std::array<double, kMax + kLanes> crossings_;
  std::int64_t first_;
  int step_;
  int count_ = 0;
  bool is_monotone_;
};

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
    if (across_.is_monotone() && down_.is_monotone())
      return traverse_monotone(from, to, band, visit);
    if (to - from < kShortest) return search(from, to);
    const double middle = 0.5 * (from + to);
    return TexelTraversal(texture_, path_, from, middle)
               .traverse(from, middle, band, visit, search) &&
           TexelTraversal(texture_, path_, middle, to).traverse(middle, to, band, visit, search);
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
