#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/event.h"
#include "core/io/files/sha256.h"

namespace saccade::testing {

/// SHA-256 of t [us] (i64), x, y (u16) and p (0 or 1, u8), little-endian, of one event after the
/// other: what any other reader can be compared by.
inline std::string event_hash(std::span<const Event> events) {
  std::vector<std::byte> bytes;
  const auto put = [&](std::uint64_t value, int size) {
    for (int i = 0; i < size; ++i) bytes.push_back(static_cast<std::byte>(value >> (8 * i)));
  };
  for (const Event& event : events) {
    put(static_cast<std::uint64_t>(event.t_ns / 1000), 8);
    put(event.x, 2);
    put(event.y, 2);
    put(event.polarity > 0 ? 1 : 0, 1);
  }
  return sha256(bytes);
}

}  // namespace saccade::testing
