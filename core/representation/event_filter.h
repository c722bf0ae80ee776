#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/event.h"
#include "core/io/events/event_file.h"

namespace saccade {

/// Background activity filter (Delbruck, Frame-free dynamic digital vision, 2008): 1 for every event
/// that one of its eight neighbouring pixels preceded by at most `within_ns` >= 0, else 0. `events`
/// are in order of time and lie within `size`.
[[nodiscard]] std::vector<std::uint8_t> supported_events(std::span<const Event> events,
                                                         SensorSize size, TimeNs within_ns);

}  // namespace saccade
