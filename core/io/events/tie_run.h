#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/event.h"

namespace saccade {

/// Of events of the same time: their place in EventOrder, and all that tells them apart.
[[nodiscard]] constexpr std::uint64_t tie_key(const Event& event) {
  return std::uint64_t{event.y} << 17U | std::uint64_t{event.x} << 1U |
         static_cast<std::uint64_t>(event.polarity > 0);
}
[[nodiscard]] constexpr Event event_of_tie_key(std::uint64_t key, TimeNs t_ns) {
  return {t_ns, static_cast<std::uint16_t>(key >> 1U), static_cast<std::uint16_t>(key >> 17U),
          static_cast<std::int8_t>((key & 1U) != 0 ? 1 : -1)};
}

/// A run of events of one time that may be longer than memory: it counts how often each pixel fires
/// with each polarity, and gives them out in EventOrder.
class TieRun {
 public:
  /// A run that is longer is counted rather than held.
  static constexpr std::size_t kMostHeld = std::size_t{1} << 21U;

  /// More events, all of the same time (contract).
  void add(std::span<const Event> events);
  /// There will be no more; they can be taken.
  void complete() { is_complete_ = true; }
  [[nodiscard]] bool is_complete() const { return is_complete_; }
  /// Whether none is left.
  [[nodiscard]] bool empty() const { return counts_.empty(); }
  /// Their time, where there are some.
  [[nodiscard]] TimeNs t_ns() const { return t_ns_; }
  /// How many are left.
  [[nodiscard]] std::uint64_t size() const { return size_; }
  /// Appends the next events, at most `most`; after the last one the run may be used anew.
  void take(std::size_t most, std::vector<Event>& events);

 private:
  struct Count {
    std::uint64_t key;
    std::uint64_t events;
  };

  TimeNs t_ns_ = 0;
  std::vector<Count> counts_;  ///< by their keys
  std::size_t next_ = 0;
  std::uint64_t size_ = 0;
  bool is_complete_ = false;
};

}  // namespace saccade
