#include "estimator/tracking/live_tracker.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "core/error.h"

namespace saccade {
namespace {

const TrackConfig& checked(const TrackConfig& config) {
  if (method_of(config).takes_frames)
    throw InputError("method", "frames takes no events; state edges, intensity or polarity");
  if (config.method == "edges" &&
      config.edges.event_frame.window == EventFrameOptions::Window::kSliding)
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
      monitor_(start_.camera, {}) {
  monitor_.set_map(world_.edge_points, world_.intensity_map.world_from_map());
}

void LiveTracker::check_new_events() const {
  const int width = start_.camera.width, height = start_.camera.height;
  TimeNs last_ns = events_[fed_ > 0 ? fed_ - 1 : 0].t_ns;
  // Without branches, since this passes over all events that there are.
  bool is_good = true;
  for (const Event& event : buffered().subspan(fed_)) {
    is_good &= (event.t_ns >= last_ns) & (event.x < width) & (event.y < height);
    last_ns = event.t_ns;
  }
  if (!is_good) report_new_events();
}

void LiveTracker::report_new_events() const {
  TimeNs last_ns = events_[fed_ > 0 ? fed_ - 1 : 0].t_ns;
  std::size_t i = fed_;
  for (; events_[i].t_ns >= last_ns && events_[i].x < start_.camera.width &&
         events_[i].y < start_.camera.height;
       ++i)
    last_ns = events_[i].t_ns;
  const Event& event = events_[i];
  const std::string location = fmt::format("events[{}]", i - fed_);
  if (event.t_ns < last_ns)
    throw InputError(location,
                     fmt::format("t = {} ns comes after {} ns; events are fed in order of time",
                                 event.t_ns, last_ns));
  throw InputError(location,
                   fmt::format("pixel ({}, {}) is not on the sensor of {} x {} pixels", event.x,
                               event.y, start_.camera.width, start_.camera.height));
}

std::span<Event> LiveTracker::room(std::size_t count) {
  const std::size_t dropped = used_ - std::min(used_, monitor_.history());
  std::copy(events_.begin() + static_cast<std::ptrdiff_t>(dropped),
            events_.begin() + static_cast<std::ptrdiff_t>(fed_), events_.begin());
  used_ -= dropped;
  fed_ -= dropped;
  end_ = fed_ + count;
  if (events_.size() < end_) events_.resize(end_);
  return std::span(events_).subspan(fed_, count);
}

std::vector<TrackedPose> LiveTracker::feed(std::span<const Event> events) {
  std::copy(events.begin(), events.end(), room(events.size()).begin());
  return feed();
}

std::vector<TrackedPose> LiveTracker::feed() {
  if (end_ == fed_) return {};
  check_new_events();
  if (!has_begun_) tracker_->reset(events_[fed_].t_ns, start_.world_from_camera);
  has_begun_ = true;
  fed_ = end_;
  if (!is_tracking_ && waiting() < tracker_->first_events()) return {};
  is_tracking_ = true;
  std::vector<TrackedPose> poses = tracker_->track({.events = buffered().subspan(used_)},
                                                   [&](std::size_t count) { used_ += count; });
  monitor_.set_recording({.events = buffered()});
  for (TrackedPose& pose : poses) monitor_.judge(pose);
  return poses;
}

}  // namespace saccade
