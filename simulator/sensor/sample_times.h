#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "core/event.h"

namespace saccade {

/// k / rate_hz for k = 0, 1, ... up to and including `duration_s`, rounded to nanoseconds so that
/// what is written at a time was also made at it; empty at rate 0.
[[nodiscard]] inline std::vector<TimeNs> sample_times(double rate_hz, double duration_s) {
  std::vector<TimeNs> times;
  if (rate_hz <= 0) return times;
  const TimeNs end = ns_from_seconds(duration_s);
  for (std::size_t k = 0;; ++k) {
    const double t_s = static_cast<double>(k) / rate_hz;
    if (t_s > duration_s + 1) return times;  // of a rate near 0 it may be no time in nanoseconds
    const TimeNs t = ns_from_seconds(t_s);
    if (t > end) return times;
    times.push_back(t);
  }
}

/// Both lists as one, increasing; times within a microsecond of one in `a` are left out.
[[nodiscard]] inline std::vector<TimeNs> merge_times(const std::vector<TimeNs>& a,
                                                     const std::vector<TimeNs>& b) {
  constexpr TimeNs kSame_ns = 1000;
  std::vector<TimeNs> merged = a;
  for (const TimeNs t : b) {
    const auto near = std::lower_bound(a.begin(), a.end(), t - kSame_ns);
    if (near == a.end() || *near > t + kSame_ns) merged.push_back(t);
  }
  std::sort(merged.begin(), merged.end());
  return merged;
}

}  // namespace saccade
