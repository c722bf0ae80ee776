#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <ranges>
#include <span>

#include "core/event.h"

namespace saccade {

/// Number of leading items whose time is before `t`. `items` are in order of time; `time_of` gives
/// the time of one, a function or a pointer to member (`&Event::t_ns`, `&StampedPose::t_s`).
template <std::ranges::random_access_range Items, class Time, class TimeOf>
[[nodiscard]] std::size_t count_before(const Items& items, Time t, TimeOf time_of) {
  const auto end = std::ranges::lower_bound(items, t, std::ranges::less{}, time_of);
  return static_cast<std::size_t>(end - std::ranges::begin(items));
}

/// The same, of the items whose time is not after `t`.
template <std::ranges::random_access_range Items, class Time, class TimeOf>
[[nodiscard]] std::size_t count_until(const Items& items, Time t, TimeOf time_of) {
  const auto end = std::ranges::upper_bound(items, t, std::ranges::less{}, time_of);
  return static_cast<std::size_t>(end - std::ranges::begin(items));
}

/// Number of leading events with t_ns < t.
[[nodiscard]] inline std::size_t count_before(std::span<const Event> events, TimeNs t) {
  return count_before(events, t, &Event::t_ns);
}

/// Number of leading events with t_ns <= t.
[[nodiscard]] inline std::size_t count_until(std::span<const Event> events, TimeNs t) {
  return count_until(events, t, &Event::t_ns);
}

/// The events with begin <= t_ns < end, in order of time as the stream is; empty where end <=
/// begin.
[[nodiscard]] inline std::span<const Event> events_between(std::span<const Event> events,
                                                           TimeNs begin, TimeNs end) {
  const std::size_t first = count_before(events, begin);
  return events.subspan(first, std::max(first, count_before(events, end)) - first);
}

/// The events with first <= t_ns <= last.
[[nodiscard]] inline std::span<const Event> events_within(std::span<const Event> events,
                                                          TimeNs first, TimeNs last) {
  const std::size_t begin = count_before(events, first);
  return events.subspan(begin, std::max(begin, count_until(events, last)) - begin);
}

}  // namespace saccade
