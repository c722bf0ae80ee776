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
    throw InputError("edges.event_window", "sliding frames need all events at once; state disjoint");
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

void LiveTracker::check(std::span<const Event> events) const {
  TimeNs last_ns = events_.empty() ? events.front().t_ns : events_.back().t_ns;
  for (std::size_t i = 0; i < events.size(); ++i) {
    const Event& event = events[i];
    if (event.t_ns < last_ns)
      throw InputError(fmt::format("events[{}]", i),
                       fmt::format("t = {} ns comes after {} ns; events are fed in order of time",
                                   event.t_ns, last_ns));
    if (event.x >= start_.camera.width || event.y >= start_.camera.height)
      throw InputError(fmt::format("events[{}]", i),
                       fmt::format("pixel ({}, {}) is not on the sensor of {} x {} pixels", event.x,
                                   event.y, start_.camera.width, start_.camera.height));
    last_ns = event.t_ns;
  }
}

std::vector<TrackedPose> LiveTracker::feed(std::span<const Event> events) {
  if (events.empty()) return {};
  check(events);
  if (!has_begun_) tracker_->reset(events.front().t_ns, start_.world_from_camera);
  has_begun_ = true;
  const std::size_t kept = std::min(used_, monitor_.history());
  events_.erase(events_.begin(), events_.begin() + static_cast<std::ptrdiff_t>(used_ - kept));
  events_.insert(events_.end(), events.begin(), events.end());
  used_ = kept;

  std::vector<TrackedPose> poses = tracker_->track({.events = std::span(events_).subspan(used_)},
                                                   [&](std::size_t count) { used_ += count; });
  monitor_.set_recording({.events = events_});
  for (TrackedPose& pose : poses) monitor_.judge(pose);
  return poses;
}

}  // namespace saccade
