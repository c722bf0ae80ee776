#pragma once

#include <cstdint>
#include <limits>
#include <span>

#include "core/event.h"
#include "core/io/events/event_file.h"
#include "core/io/events/tie_run.h"

namespace saccade {

/// Events on their way into a file: times are rounded to the nearest of its unit, and the ties that
/// this creates are sorted by EventOrder. A run of equal times is held back until it is complete,
/// because a later event may still belong before the others; a run that is too long to be held is
/// counted, and given out part by part.
class RoundedEvents {
 public:
  explicit RoundedEvents(TimestampUnit unit)
      : unit_(unit == TimestampUnit::kMicroseconds ? 1000 : 1) {}

  /// `events` ordered by time and not earlier than those added before (contract).
  void add(std::span<const Event> events);
  /// There will be no more: the last run is complete.
  void finish();
  /// Those that can be written, in EventOrder. Of a long run at least kLeast, as long as there are so
  /// many: who drops them gets the next ones, so write until there are none, or too few for a block.
  [[nodiscard]] std::span<const Event> complete() const {
    return std::span(pending_).first(open_ties_);
  }
  /// Removes the first `count` of complete().
  void drop(std::size_t count);
  /// How many there are, complete or not.
  [[nodiscard]] std::size_t size() const {
    return pending_.size() + static_cast<std::size_t>(run_.size()) + later_.size();
  }

  static constexpr std::size_t kLeast = std::size_t{1} << 20U;

 private:
  void add_rounded(const Event& event);
  void close_run();
  void count_open_ties();
  void refill();

  TimeNs unit_;  ///< [ns]
  Events pending_;
  std::size_t open_ties_ = 0;  ///< where the last run of equal times begins
  TieRun run_;                 ///< the last run, where it is too long; complete: behind pending_
  Events later_;               ///< what came behind a run that is complete
  bool is_finished_ = false;
  TimeNs last_ = std::numeric_limits<TimeNs>::min();  ///< before rounding
};

/// The greatest integer not above a / b; b > 0.
[[nodiscard]] constexpr std::int64_t floor_div(std::int64_t a, std::int64_t b) {
  return a / b - static_cast<std::int64_t>(a % b < 0);
}

/// From where a format counts whose times must be small [ns]: 0 where the first event is within the
/// first hour, else the whole second before it.
[[nodiscard]] constexpr TimeNs time_origin_ns(TimeNs first_ns) {
  constexpr TimeNs kHourNs = 3'600'000'000'000;
  constexpr TimeNs kSecondNs = 1'000'000'000;
  return first_ns < 0 || first_ns > kHourNs ? floor_div(first_ns, kSecondNs) * kSecondNs : 0;
}

}  // namespace saccade
