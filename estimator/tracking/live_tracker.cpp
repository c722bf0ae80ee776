#include "estimator/tracking/live_tracker.h"

#include <fmt/format.h>

#include <algorithm>

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
  TimeNs last_ns = fed_ > 0 ? events_[fed_ - 1].t_ns : events_[fed_].t_ns;
  for (std::size_t i = fed_; i < events_.size(); ++i) {
    const Event& event = events_[i];
    if (event.t_ns < last_ns)
      throw InputError(fmt::format("events[{}]", i - fed_),
                       fmt::format("t = {} ns comes after {} ns; events are fed in order of time",
                                   event.t_ns, last_ns));
    if (event.x >= start_.camera.width || event.y >= start_.camera.height)
      throw InputError(fmt::format("events[{}]", i - fed_),
                       fmt::format("pixel ({}, {}) is not on the sensor of {} x {} pixels", event.x,
                                   event.y, start_.camera.width, start_.camera.height));
    last_ns = event.t_ns;
  }
}

std::span<Event> LiveTracker::room(std::size_t count) {
  const std::size_t kept = std::min(used_, monitor_.history());
  const std::size_t dropped = used_ - kept;
  events_.erase(events_.begin(), events_.begin() + static_cast<std::ptrdiff_t>(dropped));
  used_ = kept;
  fed_ -= dropped;
  events_.resize(fed_ + count);
  return std::span(events_).subspan(fed_);
}

std::vector<TrackedPose> LiveTracker::feed(std::span<const Event> events) {
  std::copy(events.begin(), events.end(), room(events.size()).begin());
  return feed();
}

std::vector<TrackedPose> LiveTracker::feed() {
  if (events_.size() == fed_) return {};
  check_new_events();
  if (!has_begun_) tracker_->reset(events_[fed_].t_ns, start_.world_from_camera);
  has_begun_ = true;
  fed_ = events_.size();
  std::vector<TrackedPose> poses = tracker_->track({.events = std::span(events_).subspan(used_)},
                                                   [&](std::size_t count) { used_ += count; });
  monitor_.set_recording({.events = events_});
  for (TrackedPose& pose : poses) monitor_.judge(pose);
  return poses;
}

}  // namespace saccade
