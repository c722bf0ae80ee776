#include "estimator/run/view_windows.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include "core/time_search.h"

namespace saccade {
namespace {

using Reference = ViewWindowOptions::Reference;

/// Of the frame nearest to the middle and within; the middle without one.
double time_of_frame(const std::vector<StampedFile>& frames, double start_s, double end_s) {
  const double middle_s = (start_s + end_s) / 2;
  std::optional<double> best_s;
  for (const StampedFile& frame : frames) {
    if (frame.t_s < start_s || frame.t_s > end_s) continue;
    if (!best_s || std::abs(frame.t_s - middle_s) < std::abs(*best_s - middle_s))
      best_s = frame.t_s;
  }
  return best_s.value_or(middle_s);
}

double reference_time(Reference reference, const std::vector<StampedFile>& frames, double start_s,
                      double end_s) {
  switch (reference) {
    case Reference::kStart:
      return start_s;
    case Reference::kMiddle:
      return (start_s + end_s) / 2;
    case Reference::kEnd:
      return end_s;
    case Reference::kFrame:
      return time_of_frame(frames, start_s, end_s);
  }
  return start_s;
}

}  // namespace

void describe(config::Fields& fields, ViewWindowOptions& options) {
  fields
      .value("duration_s", options.duration_s,
             "The events are cut into the fewest windows of equal duration that are no longer than "
             "this, in seconds. It does not count where `events` is stated.")
      .range(1e-4, 1e5);
  fields
      .value("events", options.events,
             "The events are cut into the fewest windows of equally many events that hold no more "
             "than this. ~ cuts by duration instead.")
      .range(100, 1e9);
  fields.choice(
      "reference", options.reference,
      {{"start", Reference::kStart},
       {"middle", Reference::kMiddle},
       {"end", Reference::kEnd},
       {"frame", Reference::kFrame}},
      "Time of the view within its window; frame is the time of the grey frame nearest to the "
      "middle, so that the two can be compared.");
}

std::span<const Event> within(std::span<const Event> events, const Trajectory& trajectory) {
  if (trajectory.empty()) return {};
  return events_within(events, ns_from_seconds(trajectory.start_s()),
                       ns_from_seconds(trajectory.end_s()));
}

ViewWindow view_of(std::span<const Event> events, const Trajectory& trajectory,
                   const ViewWindowOptions& options, const std::vector<StampedFile>& frames) {
  const double from_s = seconds_from_ns(events.front().t_ns);
  const double to_s = seconds_from_ns(events.back().t_ns);
  return {events, &trajectory, reference_time(options.reference, frames, from_s, to_s)};
}

std::vector<ViewWindow> cut_windows(std::span<const Event> events, const Trajectory& trajectory,
                                    const ViewWindowOptions& options,
                                    const std::vector<StampedFile>& frames) {
  std::vector<ViewWindow> windows;
  if (events.empty()) return windows;
  const double start_s = seconds_from_ns(events.front().t_ns);
  const double length_s = seconds_from_ns(events.back().t_ns) - start_s;
  const auto size = static_cast<double>(events.size());
  const bool by_time = !options.events;
  const double pieces = by_time ? length_s / options.duration_s : size / *options.events;
  const auto count = static_cast<std::size_t>(std::max(1.0, std::ceil(pieces - 1e-9)));
  std::size_t begin = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double end_fraction = static_cast<double>(i + 1) / static_cast<double>(count);
    std::size_t end = events.size();
    if (i + 1 < count)
      end = by_time ? count_before(events, ns_from_seconds(start_s + end_fraction * length_s))
                    : static_cast<std::size_t>(end_fraction * size);
    if (end > begin)
      windows.push_back(view_of(events.subspan(begin, end - begin), trajectory, options, frames));
    begin = end;
  }
  return windows;
}

}  // namespace saccade
