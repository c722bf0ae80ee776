#pragma once

#include <vector>

#include "core/event.h"

namespace saccade {

/// k / rate_hz for k = 0, 1, ... up to and including `duration_s`, rounded to nanoseconds so that
/// what is written at a time was also made at it; empty at rate 0.
[[nodiscard]] std::vector<TimeNs> sample_times(double rate_hz, double duration_s);

/// Both lists as one, increasing; times within a microsecond of one in `a` are left out.
[[nodiscard]] std::vector<TimeNs> merge_times(const std::vector<TimeNs>& a,
                                              const std::vector<TimeNs>& b);

}  // namespace saccade
