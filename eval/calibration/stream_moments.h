#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/event.h"
#include "core/io/events/event_file.h"

namespace saccade {

/// Statistics of a stream by which a simulation is matched to a recording: few, each moved mostly by
/// one parameter of the sensor, and all of them smooth in the parameters.
enum Moment : Eigen::Index {
  kLogOn,      ///< ln of the number of ON events: C_on
  kLogOff,     ///< ln of the number of OFF events: C_off
  kGapShort,   ///< ln of the gaps' 10 % quantile: the blind time
  kGapLower,   ///< ln of their 25 % quantile: the blind time and the bandwidth
  kGapMiddle,  ///< ln of their median: the bandwidth
  kTurning,    ///< logit of the fraction of gaps that change polarity: the bandwidth
  kRoughness,  ///< ln of sum (n_p - n_q)^2 / sum (n_p + n_q) over neighbouring pixels: mismatch
  kMoments,
};
using Moments = Eigen::Matrix<double, kMoments, 1>;

/// What the moments of any part of a stream follow from, counted once. A part is a set of cells: the
/// stream's time is cut into kFolds equal pieces, the sensor into kBlocks blocks.
class StreamMoments {
 public:
  static constexpr std::size_t kFolds = 2;
  static constexpr int kBlocksAcross = 6, kBlocksDown = 4;
  static constexpr std::size_t kBlocks = kBlocksAcross * kBlocksDown;

  /// `events` in EventOrder, times from 0 to `duration_s` > 0. Gaps shorter than `shortest_gap_us` are
  /// not counted.
  StreamMoments(std::span<const Event> events, SensorSize size, double duration_s,
                double shortest_gap_us = 0);

  /// Of the cells (fold, block) that `takes` holds for.
  [[nodiscard]] Moments of(const std::function<bool(std::size_t, std::size_t)>& takes) const;
  /// Of the whole stream.
  [[nodiscard]] Moments all() const;

 private:
  static constexpr int kPerDecade = 60, kDecades = 8;  ///< of the gaps, from 0.1 us on
  struct Cell {
    double on = 0, off = 0;
    double same = 0, opposite = 0;  ///< gaps
    double differences = 0, sums = 0;
    std::vector<std::uint32_t> gaps = std::vector<std::uint32_t>(kPerDecade * kDecades);
  };
  [[nodiscard]] static std::size_t bin_of(double gap_us);
  [[nodiscard]] static double log_quantile(const std::vector<double>& gaps, double fraction);

  std::array<std::array<Cell, kBlocks>, kFolds> cells_;
};

}  // namespace saccade
