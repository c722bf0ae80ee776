#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "simulator/sensor/plane_path.h"

namespace saccade {

/// The borders between texels that one coordinate of a path crosses on a part of it, in order. All
/// of them are found at once, so that the compiler can vectorise it.
class Borders {
 public:
  Borders(const PlaneTrack& track, double u0, double u1) {
    const TrackPart part(track, u0, u1);
    step_ = part.slopes.low > 0 ? 1 : part.slopes.high < 0 ? -1 : 0;
    const double start = std::floor(part.from);
    is_steady_ = step_ != 0 || is_within(part.values, start);
    first_ = static_cast<std::int64_t>(start);
    const auto last = static_cast<std::int64_t>(std::floor(part.to));
    const std::int64_t count = std::abs(last - first_);
    if (step_ == 0 || count == 0) {
      crossings_[0] = u1;
      return;
    }
    is_steady_ = count <= kMost;
    if (is_steady_) find(track, u0, u1, static_cast<int>(count));
  }

  /// Whether the coordinate never turns back over a border, nor crosses too many.
  [[nodiscard]] bool is_steady() const { return is_steady_; }
  /// The texel that it is past after `k` crossings.
  [[nodiscard]] std::int64_t index(int k) const { return first_ + step_ * k; }
  /// Where it leaves that, at the latest at the end of the part.
  [[nodiscard]] double crossing(int k) const { return crossings_[static_cast<std::size_t>(k)]; }

 private:
  static constexpr int kMost = 16;

  /// From the chord and one step of Newton's method.
  void find(const PlaneTrack& track, double u0, double u1, int count) {
    const double inverse = 1 / track.chord();
    const auto border = static_cast<double>(step_ > 0 ? first_ + 1 : first_);
    for (int k = 0; k < count; ++k) {
      const double value = border + step_ * k;
      const double u = std::clamp((value - track.from()) * inverse, u0, u1);
      crossings_[static_cast<std::size_t>(k)] =
          std::clamp(u + (value - track.at(u)) / track.slope_at(u), u0, u1);
    }
    crossings_[static_cast<std::size_t>(count)] = u1;
  }

  std::array<double, kMost + 1> crossings_;
  std::int64_t first_;
  int step_;
  bool is_steady_;
};

/// Whether a path between two points of a cell, which strays less than `stray` texels from their
/// chord, may leave the open interval `band`. Along the chord the bilinear function is a parabola.
[[nodiscard]] inline bool may_leave(const std::array<float, 4>& corners, double x0, double y0,
                                    double x1, double y1, double stray, const Interval& band) {
  const double along_x = corners[1] - corners[0];
  const double along_y = corners[2] - corners[0];
  const double twist = corners[3] - corners[2] - along_x;
  const double margin = stray * (std::abs(along_x) + std::abs(along_y) + std::abs(twist));
  const double p = x1 - x0;
  const double q = y1 - y0;
  const double first = corners[0] + x0 * along_x + y0 * (along_y + twist * x0);
  const double slope = p * (along_x + twist * y0) + q * (along_y + twist * x0);
  const double bend = twist * p * q;
  Interval values{first, first};
  values.include(first + slope + bend);
  const double turn = -0.5 * slope;  // over the bend
  if (turn * bend > 0 && std::abs(turn) < std::abs(bend))
    values.include(first - turn * turn / bend);
  return !(values.low - margin > band.low && values.high + margin < band.high);
}

/// Goes along a part of a path over a texture from cell to cell and calls `look(u0, u1)` for each
/// stretch on which the texture may leave the open interval `band`, until that returns false: then
/// false. Where the path may turn back over a texel's border, in halves.
template <class Look>
bool walk_cells(const Texture& texture, const PlanePath& path, double from, double to,
                const Interval& band, const Look& look) {
  constexpr double kRounding_texel = 1e-3;
  constexpr double kShortest = 1.0 / 64;
  Borders across(path.x, from, to);
  Borders down(path.y, from, to);
  if (!across.is_steady() || !down.is_steady()) {
    if (to - from < kShortest) return look(from, to);
    const double middle = 0.5 * (from + to);
    return walk_cells(texture, path, from, middle, band, look) &&
           walk_cells(texture, path, middle, to, band, look);
  }
  const double bend = 0.125 * std::max(path.x.bend(), path.y.bend());
  double u0 = from;
  for (int right = 0, below = 0; u0 < to;) {
    const double u1 = std::min(across.crossing(right), down.crossing(below));
    const std::array<float, 4> corners = texture.cell(across.index(right), down.index(below));
    const float low = std::min(std::min(corners[0], corners[1]), std::min(corners[2], corners[3]));
    const float high = std::max(std::max(corners[0], corners[1]), std::max(corners[2], corners[3]));
    if (!(low > band.low && high < band.high)) {
      const auto i = static_cast<double>(across.index(right));
      const auto j = static_cast<double>(down.index(below));
      const double stray = bend * (u1 - u0) * (u1 - u0) + kRounding_texel;
      if (may_leave(corners, path.x.at(u0) - i, path.y.at(u0) - j, path.x.at(u1) - i,
                    path.y.at(u1) - j, stray, band) &&
          !look(u0, u1))
        return false;
    }
    const bool is_right = across.crossing(right) <= down.crossing(below);
    right += is_right ? 1 : 0;
    below += is_right ? 0 : 1;
    u0 = u1;
  }
  return true;
}

}  // namespace saccade
