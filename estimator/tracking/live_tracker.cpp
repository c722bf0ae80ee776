#include "estimator/tracking/live_tracker.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <string>

#include "core/error.h"
#include "core/event_pair.h"

namespace saccade {
namespace {

const TrackConfig& checked(const TrackConfig& config) {
  if (method_of(config).takes_frames)
    throw InputError("method", "frames takes no events; state edges, intensity or polarity");
  if (!is_fed_in_pieces(config))
    throw InputError("edges.event_window",
                     "sliding frames need all events at once; state disjoint");
  return config;
}

}  // namespace

LiveTracker::LiveTracker(const TrackConfig& config, const Dataset& dataset, double start_s,
                         double end_s)
    : config_(checked(config)),
      start_(load_track_start(config_, dataset, start_s, end_s)),
      world_(world_of(config_, start_)),
      tracker_(method_of(config_).make(config_, world_)),
      feed_(*tracker_, world_, start_.world_from_camera) {}

bool LiveTracker::is_good(const Event& event, TimeNs last_ns) const {
  return event.t_ns >= last_ns && event.x < start_.camera.width && event.y < start_.camera.height;
}

// In pairs and without branches, since this passes over all events that there are.
void LiveTracker::check_new_events() const {
  const std::span<const Event> events = new_events_;
  constexpr EventPair kTimes = event_pair(-1, 0);
  constexpr std::int64_t kAny = std::numeric_limits<std::int64_t>::max();
  const EventPair last_x = event_pair(kAny, start_.camera.width - 1);
  const EventPair last_y = event_pair(kAny, start_.camera.height - 1);
  EventPair bad{};
  std::size_t i = 1;
  for (; i + 2 <= events.size(); i += 2) {
    const EventPair pair = load_event_pair(&events[i]);
    bad |= (pair < load_event_pair(&events[i - 1])) & kTimes;
    bad |= ((pair & 0xFFFF) > last_x) | ((pair >> 16 & 0xFFFF) > last_y);
  }
  if ((bad[0] | bad[1] | bad[2] | bad[3]) != 0 ||
      !is_good(events.front(), last_ns_.value_or(events.front().t_ns)) ||
      !is_good(events.back(), events[events.size() < 2 ? 0 : events.size() - 2].t_ns))
    report_new_events();
}

void LiveTracker::report_new_events() const {
  TimeNs last_ns = last_ns_.value_or(new_events_.front().t_ns);
  std::size_t i = 0;
  for (; is_good(new_events_[i], last_ns); ++i) last_ns = new_events_[i].t_ns;
  const Event& event = new_events_[i];
  const std::string location = fmt::format("events[{}]", i);
  if (event.t_ns < last_ns)
    throw InputError(location,
                     fmt::format("t = {} ns comes after {} ns; events are fed in order of time",
                                 event.t_ns, last_ns));
  throw InputError(location,
                   fmt::format("pixel ({}, {}) is not on the sensor of {} x {} pixels", event.x,
                               event.y, start_.camera.width, start_.camera.height));
}

std::span<Event> LiveTracker::room(std::size_t count) {
  const std::span<Event> room = feed_.room(count);
  new_events_ = room;
  return room;
}

std::vector<TrackedPose> LiveTracker::feed(std::span<const Event> events) {
  std::copy(events.begin(), events.end(), room(events.size()).begin());
  return feed();
}

std::vector<TrackedPose> LiveTracker::feed() {
  if (new_events_.empty()) return {};
  check_new_events();
  last_ns_ = new_events_.back().t_ns;
  new_events_ = {};
  return feed_.feed();
}

}  // namespace saccade
