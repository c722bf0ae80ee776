#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "core/event.h"

namespace saccade {

/// The times between successive events of the same pixel, as a histogram that forgets. Pixels that
/// are blind for a while after each event have none below that time, and many right above it when
/// steep edges pass: that tells how long it is, and whether it hides much.
class EventIntervals {
 public:
  void add(TimeNs interval_ns) {
    const double us = 1e-3 * static_cast<double>(std::max<TimeNs>(interval_ns, 0));
    const double bin = us < kFirst_us ? 0 : 1 + kPerOctave * std::log2(us / kFirst_us);
    const std::size_t i = std::min(static_cast<std::size_t>(bin), kBins - 1);
    counts_[i] += 1;
    if (++count_ < kMemory) return;
    for (float& count : counts_) count *= 0.5F;
    count_ /= 2;
  }

  /// One in a hundred intervals is shorter [s]; 0 where some of them are none at all, or too few are
  /// known.
  [[nodiscard]] double shortest_s() const {
    const std::size_t bin = shortest_bin();
    return bin == 0 ? 0 : 1e-6 * kFirst_us * std::exp2(static_cast<double>(bin - 1) / kPerOctave);
  }

  /// Whether some pixels fire several times at once, as only ideal ones do; so at first.
  [[nodiscard]] bool has_bursts() const { return shortest_bin() == 0; }

  /// 0..1: how much the intervals pile up right above the shortest, from a tenth of all of them
  /// within a factor of 1.5 on.
  [[nodiscard]] float pile_up() const {
    const std::size_t first = shortest_bin();
    if (first == 0) return 0;
    constexpr std::size_t kHalfAsLong = 5;  // 2^(4.7 / 8) = 1.5
    double within = 0;
    for (std::size_t i = 0; i < std::min(first + kHalfAsLong, kBins); ++i)
      within += static_cast<double>(counts_[i]);
    constexpr double kUsual = 0.1, kCertain = 0.25;
    const double fraction = within / static_cast<double>(count_);
    return static_cast<float>(std::clamp((fraction - kUsual) / (kCertain - kUsual), 0.0, 1.0));
  }

 private:
  static constexpr double kFirst_us = 10;
  static constexpr double kPerOctave = 8;
  static constexpr std::size_t kBins = 1 + 8 * 16;  ///< to 0.65 s
  static constexpr std::size_t kEnough = 2000;
  static constexpr std::size_t kMemory = 200000;

  [[nodiscard]] std::size_t shortest_bin() const {
    if (count_ < kEnough) return 0;
    double below = 0;
    std::size_t bin = 0;
    while (bin + 1 < kBins &&
           below + static_cast<double>(counts_[bin]) <= 0.01 * static_cast<double>(count_))
      below += static_cast<double>(counts_[bin++]);
    return bin;
  }

  std::array<float, kBins> counts_{};
  std::size_t count_ = 0;
};

}  // namespace saccade
