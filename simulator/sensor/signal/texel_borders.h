#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "simulator/sensor/signal/texel_trajectory.h"

namespace saccade {

/// The borders between texels that one coordinate of a path crosses on a part of it, in order. All
/// of them are found at once, in whole lanes for the compiler to vectorise.
class TexelBorders {
 public:
  /// At most so many are crossed. They are found in whole lanes.
  static constexpr int kMax = 16;
  static constexpr std::size_t kLanes = 8;
  static constexpr std::size_t kPadded = kMax + kLanes;

  explicit TexelBorders(const TrajectoryCoordinate& track)
      : TexelBorders(track, CoordinateBounds(track), 0, 1) {}
  TexelBorders(const TrajectoryCoordinate& track, double u0, double u1)
      : TexelBorders(track, CoordinateBounds::over(track, u0, u1), u0, u1) {}

  /// Whether the coordinate never turns back over a border, nor crosses too many.
  [[nodiscard]] bool is_monotone() const { return is_monotone_; }
  /// The texel that it is past after `k` crossings.
  [[nodiscard]] std::int64_t index(std::int64_t k) const { return first_ + step_ * k; }
  /// Where it leaves that, at the latest at the end of the part.
  [[nodiscard]] double crossing(int k) const { return crossings_[static_cast<std::size_t>(k)]; }
  /// The number of crossings up to `u`.
  [[nodiscard]] int passed(double u) const {
    int k = 0;
    while (k < count_ && crossing(k) <= u) ++k;
    return k;
  }
  /// All crossings, padded to whole lanes.
  [[nodiscard]] const std::array<double, kPadded>& crossings() const { return crossings_; }
  /// Where the part begins.
  [[nodiscard]] double start() const { return start_; }
  [[nodiscard]] int count() const { return count_; }

 private:
  TexelBorders(const TrajectoryCoordinate& track, const CoordinateBounds& part, double u0,
               double u1)
      : start_(u0) {
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
    for (int k = 0; k < count_; k += static_cast<int>(kLanes))
      for (int lane = 0; lane < static_cast<int>(kLanes); ++lane) {
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

  double start_;
  std::array<double, kPadded> crossings_;
  std::int64_t first_;
  int step_;
  int count_ = 0;
  bool is_monotone_;
};

}  // namespace saccade
