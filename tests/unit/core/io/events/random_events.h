#pragma once

#include <cstddef>
#include <cstdint>

#include "core/event.h"
#include "core/io/events/event_file.h"
#include "core/random.h"

namespace saccade::testing {

/// The sensor of random_events().
constexpr SensorSize kSensor{240, 180};

/// Events of kSensor in EventOrder, on average `step_ns` apart, some at equal
/// times.
inline Events random_events(std::size_t count, TimeNs start_ns = 0, TimeNs step_ns = 700) {
  const Random random(11);
  Events events;
  TimeNs t = start_ns;
  for (std::uint64_t i = 0; i < count; ++i) {
    if (random.below(4, 0, i) != 0)
      t += static_cast<TimeNs>(random.below(static_cast<std::uint64_t>(step_ns) * 8 / 3, 1, i));
    events.push_back({t, static_cast<std::uint16_t>(random.below(240, 2, i)),
                      static_cast<std::uint16_t>(random.below(180, 3, i)),
                      static_cast<std::int8_t>(random.below(2, 4, i) == 0 ? -1 : 1)});
  }
  return events;
}

}  // namespace saccade::testing
