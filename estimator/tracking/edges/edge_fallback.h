#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "estimator/tracking/edges/edge_tracker.h"

namespace saccade {

/// What the methods that compare intensities do when these say nothing about the pose: the edges of
/// the map, which need neither the log intensities of the pixels nor a velocity, are followed for a few frames.
class EdgeFallback {
 public:
  explicit EdgeFallback(EdgeTracker edges) : edges_(std::move(edges)) {}

  /// From a known pose.
  void reset(TimeNs t_ns, const Rigid3& world_from_camera) {
    edges_.reset(t_ns, world_from_camera);
  }
  /// From a pose that is right within some pixels.
  void reset_near(TimeNs t_ns, const Rigid3& world_from_camera) {
    constexpr double kSigma_px = 4;
    edges_.reset(t_ns, world_from_camera, kSigma_px);
  }

  /// Follows the first frames of a recording's events and appends their poses, all of them lost
  /// where they do not fit. Returns the number of events; 0, and nothing is appended, where there
  /// are fewer frames and more events come, or where not even one frame is left.
  std::size_t follow(const Recording& recording, std::vector<TrackedPose>& poses,
                     TrackTiming& timing) {
    constexpr std::size_t kFrames = 6;
    const std::size_t frame = edges_.next_frame_events();
    const std::size_t frames = std::min(kFrames, recording.events.size() / frame);
    if (frames == 0 || (frames < kFrames && !recording.is_complete)) return 0;
    const std::size_t count = frames * frame;
    follow_all(recording.events.first(count), poses, timing);
    return count;
  }

  /// The same with all frames of `events`.
  void follow_all(std::span<const Event> events, std::vector<TrackedPose>& poses,
                  TrackTiming& timing) {
    const TrackTiming before = edges_.timing();
    std::vector<TrackedPose> found = edges_.track({.events = events});
    timing.view_s += edges_.timing().view_s - before.view_s;
    timing.load_s += edges_.timing().load_s - before.load_s;
    timing.align_s += edges_.timing().align_s - before.align_s;
    double inlier_ratio = 0;
    for (const TrackedPose& pose : found)
      inlier_ratio += pose.inlier_ratio / static_cast<double>(found.size());
    fits_ = inlier_ratio >= edges_.min_inlier_ratio();
    if (!fits_)
      for (TrackedPose& pose : found) pose.status = TrackStatus::kLost;
    poses.insert(poses.end(), found.begin(), found.end());
  }

  /// Whether the frames of the last follow() had enough inliers, on average.
  [[nodiscard]] bool fits() const { return fits_; }
  [[nodiscard]] const MotionModel& motion() const { return edges_.motion(); }

 private:
  EdgeTracker edges_;
  bool fits_ = false;
};

}  // namespace saccade
