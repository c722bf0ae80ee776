#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "simulator/scene/texture/texture.h"
#include "simulator/sensor/signal/texel_borders.h"

namespace saccade {

/// The cells of a texture that a path passes through while neither of its coordinates turns back,
/// in order. All are looked up at once and stand side by side for the compiler to vectorise, for
/// signals of which everything between two crossings counts; TexelTraversal looks for crossings
/// alone and stops at the first.
class PathCells {
 public:
  static constexpr int kMax = 2 * TexelBorders::kMax + 1;

  /// No cells where a coordinate is not monotone.
  PathCells(const Texture& texture, const TexelBorders& across, const TexelBorders& down) {
    if (!across.is_monotone() || !down.is_monotone()) return;
    count_ = across.count() + down.count() + 1;
    start_ = across.start();
    const Passed rows = passed_before(across, down, [](double a, double b) { return b < a; });
    const Passed columns = passed_before(down, across, [](double a, double b) { return b <= a; });
    const auto add = [&](std::int64_t column, std::int64_t row, double end) {
      const auto k = static_cast<std::size_t>(column + row);
      ends_[k] = end;
      i_[k] = across.index(column);
      j_[k] = down.index(row);
    };
    for (int k = 0; k < across.count(); ++k)
      add(k, rows[static_cast<std::size_t>(k)], across.crossing(k));
    for (int k = 0; k < down.count(); ++k)
      add(columns[static_cast<std::size_t>(k)], k, down.crossing(k));
    add(across.count(), down.count(), across.crossing(across.count()));
    look_up(texture);
  }

  [[nodiscard]] int count() const { return count_; }
  /// Where the first cell begins.
  [[nodiscard]] double start() const { return start_; }
  /// Column and row of cell `k`.
  [[nodiscard]] std::int64_t i(int k) const { return i_[static_cast<std::size_t>(k)]; }
  [[nodiscard]] std::int64_t j(int k) const { return j_[static_cast<std::size_t>(k)]; }
  /// Where the path leaves it.
  [[nodiscard]] double end(int k) const { return ends_[static_cast<std::size_t>(k)]; }
  /// Its texels, as Texture::cell() has them.
  [[nodiscard]] std::array<float, 4> corners(int k) const {
    const auto at = static_cast<std::size_t>(k);
    return {corners_[0][at], corners_[1][at], corners_[2][at], corners_[3][at]};
  }

  /// The least of its texels.
  [[nodiscard]] double low(int k) const {
    return static_cast<double>(lows_[static_cast<std::size_t>(k)]);
  }

  /// The cell in which the path is right after `u`.
  [[nodiscard]] int at(double u) const {
    int k = 0;
    while (k + 1 < count_ && end(k) <= u) ++k;
    return k;
  }
  /// The first cell from `k` on with a texel that is not within the open interval `band`; count()
  /// where there is none.
  template <class Band>
  [[nodiscard]] int next_outside(int k, const Band& band) const {
    for (; k < count_; ++k) {
      const auto at = static_cast<std::size_t>(k);
      if (!(static_cast<double>(lows_[at]) > band.low &&
            static_cast<double>(highs_[at]) < band.high))
        break;
    }
    return k;
  }

 private:
  static constexpr std::size_t kLanes = 16;
  static constexpr std::size_t kPadded = (kMax + kLanes - 1) / kLanes * kLanes;
  using Floats = std::array<float, kPadded>;
  using Passed = std::array<std::int64_t, TexelBorders::kPadded>;

  /// How many borders of `others` the path has passed at each of `borders`.
  template <class IsBefore>
  [[nodiscard]] static Passed passed_before(const TexelBorders& borders, const TexelBorders& others,
                                            const IsBefore& is_before) {
    constexpr std::size_t kBlock = TexelBorders::kLanes;
    Passed passed;
    for (std::size_t first = 0; first < static_cast<std::size_t>(borders.count());
         first += kBlock) {
      std::array<double, kBlock> own;
      std::array<std::int64_t, kBlock> sums{};
      std::copy_n(&borders.crossings()[first], kBlock, own.begin());
      for (int m = 0; m < others.count(); ++m) {
        const double other = others.crossing(m);
        for (std::size_t lane = 0; lane < kBlock; ++lane)
          sums[lane] += is_before(own[lane], other) ? 1 : 0;
      }
      std::copy_n(sums.begin(), kBlock, &passed[first]);
    }
    return passed;
  }

  void look_up(const Texture& texture) {
    const auto count = static_cast<std::size_t>(count_);
    for (std::size_t k = 0; k < count; ++k) {
      const std::array<float, 4> texels = texture.cell(i_[k], j_[k]);
      for (std::size_t c = 0; c < texels.size(); ++c) corners_[c][k] = texels[c];
    }
    for (std::size_t k = count; k % kLanes != 0; ++k)
      for (Floats& corner : corners_) corner[k] = corner[count - 1];
    for (std::size_t first = 0; first < count; first += kLanes)
      for (std::size_t k = first; k < first + kLanes; ++k) {
        const float a = corners_[0][k];
        const float b = corners_[1][k];
        const float c = corners_[2][k];
        const float d = corners_[3][k];
        const float low_ab = a < b ? a : b;
        const float low_cd = c < d ? c : d;
        const float high_ab = a < b ? b : a;
        const float high_cd = c < d ? d : c;
        lows_[k] = low_ab < low_cd ? low_ab : low_cd;
        highs_[k] = high_ab < high_cd ? high_cd : high_ab;
      }
  }

  int count_ = 0;
  double start_ = 0;
  std::array<double, kMax> ends_;
  std::array<std::int64_t, kMax> i_, j_;
  std::array<Floats, 4> corners_;
  Floats lows_, highs_;
};

}  // namespace saccade
