#pragma once

#include <span>

#include "core/check.h"
#include "core/event.h"

namespace saccade {

/// Mean time of the events [ns], which stamps the pose of their frame; at least one event.
[[nodiscard]] inline TimeNs mean_time(std::span<const Event> events) {
  SACCADE_CHECK(!events.empty());
  const TimeNs first = events.front().t_ns;
  TimeNs sum = 0;
  for (const Event& e : events) sum += e.t_ns - first;
  return first + sum / static_cast<TimeNs>(events.size());
}

}  // namespace saccade
