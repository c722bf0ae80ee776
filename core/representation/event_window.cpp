#include "core/representation/event_window.h"

#include <algorithm>

namespace saccade {
namespace {

std::size_t first_not_before(std::span<const Event> events, TimeNs t_ns) {
  const auto found = std::ranges::lower_bound(events, t_ns, {}, &Event::t_ns);
  return static_cast<std::size_t>(found - events.begin());
}

GridWindow between(std::span<const Event> events, TimeNs from_ns, TimeNs to_ns) {
  return {from_ns, to_ns, first_not_before(events, from_ns), first_not_before(events, to_ns)};
}

TimeNs floor_div(TimeNs a, TimeNs b) { return a / b - (a % b < 0 ? 1 : 0); }

std::vector<GridWindow> windows_of_time(std::span<const Event> events, TimeNs duration_ns) {
  std::vector<GridWindow> windows;
  for (TimeNs k = floor_div(events.front().t_ns, duration_ns);
       k * duration_ns <= events.back().t_ns; ++k)
    windows.push_back(between(events, k * duration_ns, (k + 1) * duration_ns));
  return windows;
}

std::vector<GridWindow> windows_of_events(std::span<const Event> events, std::size_t count) {
  std::vector<GridWindow> windows;
  for (std::size_t first = 0; first < events.size(); first += count) {
    const std::size_t last = std::min(first + count, events.size());
    windows.push_back({events[first].t_ns, events[last - 1].t_ns, first, last});
  }
  return windows;
}

}  // namespace

void describe_windows(config::Fields& fields, WindowOptions& options) {
  fields
      .value("duration_s", options.duration_s,
             "Length of a window in seconds; windows begin at its multiples. 0: no such windows.")
      .range(0, 1e6);
  fields
      .value("events", options.events,
             "Number of events in a window; the last one has the rest. 0: no such windows.")
      .at_least(0);
  fields.value("by_frames", options.by_frames,
               "Whether a window reaches from each frame of the dataset to the next.");
  const int stated =
      (options.duration_s > 0 ? 1 : 0) + (options.events > 0 ? 1 : 0) + (options.by_frames ? 1 : 0);
  fields.expect(stated <= 1, "duration_s", "and 'events' and 'by_frames' exclude one another");
  fields.expect(options.duration_s == 0 || options.duration_s >= 1e-6, "duration_s",
                "must be 0 or at least 1e-6");
}

std::vector<GridWindow> cut_windows(std::span<const Event> events, const WindowOptions& options,
                                    std::span<const TimeNs> frames) {
  if (events.empty()) return {};
  if (options.duration_s > 0) return windows_of_time(events, ns_from_seconds(options.duration_s));
  if (options.events > 0)
    return windows_of_events(events, static_cast<std::size_t>(options.events));
  if (!options.by_frames) return {{events.front().t_ns, events.back().t_ns, 0, events.size()}};
  std::vector<GridWindow> windows;
  for (std::size_t i = 0; i + 1 < frames.size(); ++i)
    windows.push_back(between(events, frames[i], frames[i + 1]));
  return windows;
}

}  // namespace saccade
