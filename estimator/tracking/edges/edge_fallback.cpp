#include "estimator/tracking/edges/edge_fallback.h"

namespace saccade {

std::size_t EdgeFallback::follow(std::span<const Event> events, std::vector<TrackedPose>& poses,
                                 TrackTiming& timing) {
  constexpr std::size_t kFrames = 6;
  const TrackTiming before = edges_.timing();
  const std::size_t count = kFrames * edges_.next_frame_events();
  if (count > events.size()) return 0;
  std::vector<TrackedPose> found = edges_.track({.events = events.first(count)});
  timing.template_s += edges_.timing().template_s - before.template_s;
  timing.event_frame_s += edges_.timing().event_frame_s - before.event_frame_s;
  timing.align_s += edges_.timing().align_s - before.align_s;
  double inlier_ratio = 0;
  for (const TrackedPose& pose : found)
    inlier_ratio += pose.inlier_ratio / static_cast<double>(found.size());
  fits_ = inlier_ratio >= edges_.min_inlier_ratio();
  if (!fits_)
    for (TrackedPose& pose : found) pose.status = TrackStatus::kLost;
  poses.insert(poses.end(), found.begin(), found.end());
  return count;
}

}  // namespace saccade
