#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "eval/metrics/trajectory/loss_metrics.h"
#include "eval/metrics/trajectory/trajectory_metrics.h"

namespace saccade {

/// How often poses of about one stated probability are right.
struct ReliabilityBin {
  double predicted = 0;  ///< sum of the probabilities
  double good = 0;       ///< instants that are not truly lost
  double instants = 0;
};

/// The bins of a reliability diagram (Murphy & Winkler, 1977), of equal width over 0..1.
using ReliabilityBins = std::array<ReliabilityBin, 10>;

/// Adds the instants of a run, on the grid of the scored interval: the probability of the row in
/// force against whether the pose is truly lost. Nothing is added where either is not known.
inline void add_reliability(const TrajectoryScoreInput& input, const ErrorSeries& series,
                            ReliabilityBins& bins) {
  const std::vector<bool> lost = truly_lost(series);
  if (!input.reported) return;
  for (std::size_t i = 0; i < lost.size(); ++i) {
    const std::optional<std::size_t> row = row_in_force(*input.reported, series.t_s[i]);
    if (!row || !(*input.reported)[*row].probability) continue;
    const double p = std::clamp(*(*input.reported)[*row].probability, 0.0, 1.0);
    const auto index = static_cast<std::size_t>(p * static_cast<double>(bins.size()));
    ReliabilityBin& bin = bins[std::min(index, bins.size() - 1)];
    bin.predicted += p;
    bin.good += lost[i] ? 0 : 1;
    bin.instants += 1;
  }
}

}  // namespace saccade
