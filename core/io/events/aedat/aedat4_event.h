#pragma once

#include <cstddef>

namespace saccade {

// An event in a packet of AEDAT4: the time in us (i64), column and row (i16), 1 for ON (u8).
constexpr std::size_t kAedat4EventBytes = 16;
constexpr std::size_t kAedat4XAt = 8;
constexpr std::size_t kAedat4YAt = 10;
constexpr std::size_t kAedat4OnAt = 12;

/// Field of the events in their packet's table.
constexpr unsigned kAedat4EventsField = 0;

}  // namespace saccade
