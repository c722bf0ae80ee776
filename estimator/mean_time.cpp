#include "estimator/mean_time.h"

#include "core/check.h"

namespace saccade {

TimeNs mean_time(std::span<const Event> events) {
  SACCADE_CHECK(!events.empty());
  const TimeNs first = events.front().t_ns;
  TimeNs sum = 0;
  for (const Event& e : events) sum += e.t_ns - first;
  return first + sum / static_cast<TimeNs>(events.size());
}

}  // namespace saccade
