#pragma once

#include <chrono>
#include <thread>

#include "core/event.h"

namespace saccade {

/// The clock of a recording that is played as it was recorded: an event arrives when as much time
/// has passed since the clock was started as lies between the first event and it.
class EventClock {
 public:
  /// Starts now, when an event of `first_ns` arrives.
  explicit EventClock(TimeNs first_ns) : first_ns_(first_ns), start_(Clock::now()) {}

  /// Sleeps until an event of this time has arrived.
  void wait_for(TimeNs t_ns) const { std::this_thread::sleep_until(arrival(t_ns)); }
  /// How long ago it arrived [ms]; below 0 for one that is yet to come.
  [[nodiscard]] double age_ms(TimeNs t_ns) const {
    return std::chrono::duration<double, std::milli>(Clock::now() - arrival(t_ns)).count();
  }
  /// The time of the events that arrive now.
  [[nodiscard]] TimeNs now_ns() const {
    return first_ns_ +
           std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now() - start_).count();
  }

 private:
  using Clock = std::chrono::steady_clock;
  [[nodiscard]] Clock::time_point arrival(TimeNs t_ns) const {
    return start_ + std::chrono::nanoseconds(t_ns - first_ns_);
  }

  TimeNs first_ns_;
  Clock::time_point start_;
};

}  // namespace saccade
