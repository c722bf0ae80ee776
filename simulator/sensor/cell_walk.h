#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "simulator/sensor/texel_path.h"

namespace saccade {

/// The borders between texels that one coordinate of a path crosses, in order.
class Borders {
 public:
  explicit Borders(const Track& track) : track_(track) {
    const Interval slopes = track.slopes();
    step_ = slopes.low > 0 ? 1 : slopes.high < 0 ? -1 : 0;
    const double first = std::floor(track.from);
    index_ = static_cast<std::int64_t>(first) - (step_ < 0 && track.from == first ? 1 : 0);
    is_steady_ = step_ != 0 || is_within(track.values(), first);
    inverse_ = 1 / track.chord;
    is_even_ = track.bend() * track.bend() < kEven_texel * std::abs(track.chord);
    seek(0);
  }

  /// Whether the coordinate never turns back over a border.
  [[nodiscard]] bool is_steady() const { return is_steady_; }
  /// Of the texel that it is past now.
  [[nodiscard]] std::int64_t index() const { return index_; }
  /// Where it leaves that; 1 at the latest.
  [[nodiscard]] double next() const { return next_; }
  void pass() {
    index_ += step_;
    seek(next_);
  }

 private:
  /// From the chord and one step of Newton's method, for which the chord's slope will do where the
  /// path is nearly even.
  void seek(double from) {
    next_ = 1;
    const auto border = static_cast<double>(step_ > 0 ? index_ + 1 : index_);
    if (step_ == 0 || step_ * (border - track_.to) >= 0) return;
    const double u = (border - track_.from) * inverse_;
    const double ahead = border - track_.at(u);
    next_ = std::clamp(u + (is_even_ ? ahead * inverse_ : ahead / track_.slope_at(u)), from, 1.0);
  }

  static constexpr double kEven_texel = 1e-4;

  const Track& track_;
  double inverse_;
  double next_ = 1;
  std::int64_t index_;
  int step_;
  bool is_steady_;
  bool is_even_;
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

/// Goes along a path over a texture from cell to cell and calls `look(u0, u1)` for each stretch on
/// which the texture may leave the open interval `band`, until that returns false. False, and
/// nothing is done, where the path turns back over a texel's border.
template <class Look>
bool walk_cells(const Texture& texture, const Track& x, const Track& y, const Interval& band,
                const Look& look) {
  constexpr double kRounding_texel = 1e-4;
  Borders across(x);
  Borders down(y);
  if (!across.is_steady() || !down.is_steady()) return false;
  const double bend = std::max(x.bend(), y.bend());
  double u0 = 0;
  while (true) {
    const double u1 = std::min(across.next(), down.next());
    const std::array<float, 4> corners = texture.cell(across.index(), down.index());
    const float low = std::min(std::min(corners[0], corners[1]), std::min(corners[2], corners[3]));
    const float high = std::max(std::max(corners[0], corners[1]), std::max(corners[2], corners[3]));
    if (!(low > band.low && high < band.high)) {
      const auto i = static_cast<double>(across.index());
      const auto j = static_cast<double>(down.index());
      const double stray = bend * (u1 - u0) * (u1 - u0) + kRounding_texel;
      if (may_leave(corners, x.at(u0) - i, y.at(u0) - j, x.at(u1) - i, y.at(u1) - j, stray, band) &&
          !look(u0, u1))
        return true;
    }
    if (u1 >= 1) return true;
    (across.next() <= down.next() ? across : down).pass();
    u0 = u1;
  }
}

}  // namespace saccade
