#include "estimator/odometry/event_clock.h"

#include <thread>

namespace saccade {

void EventClock::wait_for(TimeNs t_ns) const { std::this_thread::sleep_until(arrival(t_ns)); }

double EventClock::age_ms(TimeNs t_ns) const {
  return std::chrono::duration<double, std::milli>(Clock::now() - arrival(t_ns)).count();
}

TimeNs EventClock::now_ns() const {
  return first_ns_ +
         std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now() - start_).count();
}

}  // namespace saccade
