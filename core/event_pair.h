#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "core/event.h"

namespace saccade {

/// Two neighbouring events as integers, for loops over all events that there are: time, rest, time,
/// rest. Of a rest the lowest 16 bits are x, the next 16 y, the next 8 the polarity.
using EventPair = std::int64_t __attribute__((vector_size(2 * sizeof(Event))));

static_assert(sizeof(Event) == 16 && offsetof(Event, t_ns) == 0 && offsetof(Event, x) == 8 &&
              offsetof(Event, y) == 10 && offsetof(Event, polarity) == 12 &&
              std::endian::native == std::endian::little);

/// An EventPair whose two rests are `rest` and whose times are `time`.
[[nodiscard]] constexpr EventPair event_pair(std::int64_t time, std::int64_t rest) {
  return EventPair{time, rest, time, rest};
}

/// Two events that may lie at any address.
[[nodiscard]] inline EventPair load_event_pair(const void* events) {
  EventPair pair;
  std::memcpy(&pair, events, sizeof pair);
  return pair;
}

inline void store_event_pair(const EventPair& pair, Event* events) {
  std::memcpy(static_cast<void*>(events), &pair, sizeof pair);
}

}  // namespace saccade
