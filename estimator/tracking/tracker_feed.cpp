#include "estimator/tracking/tracker_feed.h"

#include <algorithm>

#include "core/stopwatch.h"

namespace saccade {

bool is_fed_in_pieces(const TrackConfig& config) {
  const bool is_sliding = config.method == "edges" &&
                          config.edges.event_frame.window == EventFrameOptions::Window::kSliding;
  return !is_sliding && !method_of(config).takes_frames;
}

TrackerFeed::TrackerFeed(Tracker& tracker, const TrackWorld& world, const Rigid3& world_from_camera)
    : tracker_(tracker), world_from_camera_(world_from_camera), monitor_(world.camera, {}) {
  monitor_.set_map(world.edge_points, world.intensity_map.world_from_map());
}

std::span<Event> TrackerFeed::room(std::size_t count) {
  const std::size_t dropped = used_ - std::min(used_, monitor_.history());
  std::copy(events_.begin() + static_cast<std::ptrdiff_t>(dropped),
            events_.begin() + static_cast<std::ptrdiff_t>(fed_), events_.begin());
  used_ -= dropped;
  fed_ -= dropped;
  end_ = fed_ + count;
  if (events_.size() < end_) events_.resize(end_);
  return std::span(events_).subspan(fed_, count);
}

std::vector<TrackedPose> TrackerFeed::feed() {
  if (end_ == fed_) return {};
  if (!has_begun_) tracker_.reset(events_[fed_].t_ns, world_from_camera_);
  has_begun_ = true;
  fed_ = end_;
  if (!is_tracking_ && waiting() < tracker_.first_events()) return {};
  return track_waiting(false);
}

std::vector<TrackedPose> TrackerFeed::finish() {
  if (waiting() == 0) return {};
  return track_waiting(true);
}

std::vector<TrackedPose> TrackerFeed::track_waiting(bool is_complete) {
  is_tracking_ = true;
  const std::span<const Event> events = std::span(events_).first(fed_);
  std::vector<TrackedPose> poses =
      tracker_.track({.events = events.subspan(used_), .is_complete = is_complete},
                     [&](std::size_t count) { used_ += count; });
  const ScopedTimer clock(check_s_);
  monitor_.set_recording({.events = events});
  for (TrackedPose& pose : poses) monitor_.judge(pose);
  return poses;
}

}  // namespace saccade
