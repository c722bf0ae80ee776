#pragma once

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "estimator/tracking/edges/edge_tracker.h"

namespace saccade {

/// What the methods that compare intensities do when these say nothing about the pose: the edges of
/// the map, which need neither past levels nor a velocity, are followed for a few frames.
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

  /// Follows the first frames of `events` and appends their poses, all of them lost where they do
  /// not fit. Returns the number of events; 0, and nothing is appended, where too few are left.
  std::size_t follow(std::span<const Event> events, std::vector<TrackedPose>& poses,
                     TrackTiming& timing);

  /// Whether the frames of the last follow() had enough inliers, on average.
  [[nodiscard]] bool fits() const { return fits_; }
  [[nodiscard]] const MotionModel& motion() const { return edges_.motion(); }

 private:
  EdgeTracker edges_;
  bool fits_ = false;
};

}  // namespace saccade
