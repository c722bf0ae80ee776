#pragma once

#include <span>

#include "core/event.h"
#include "core/io/events/event_file.h"

namespace saccade {

/// How a simulated stream differs from the recorded one that it stands for, over the same pixels and
/// time; each 0, but the ratio 1, where both are alike.
struct StreamDistance {
  double event_ratio = 0;     ///< simulated / recorded
  double on_points = 0;       ///< ON fraction, simulated - recorded [percentage points]
  double gap_decades = 0;     ///< gap_distance() of all gaps
  double rate_variation = 0;  ///< of the events per 5 ms: total variation distance, 0..1
  double map_variation = 0;   ///< of the events per 8 x 8 pixels, likewise
};

/// Both at least one event, in EventOrder and inside `size`; times from the same zero.
[[nodiscard]] StreamDistance stream_distance(std::span<const Event> recorded,
                                             std::span<const Event> simulated, SensorSize size);

/// Mean distance between equal quantiles of the logarithms of two sets of gaps (the area between
/// their cumulative distributions, Wasserstein's distance of order 1) [decades]. Ascending and > 0;
/// 0 where one of them is empty.
[[nodiscard]] double gap_distance(std::span<const double> a, std::span<const double> b);

}  // namespace saccade
