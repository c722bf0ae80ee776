#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/camera.h"
#include "core/event.h"
#include "core/trajectory.h"
#include "estimator/odometry/edge_map.h"
#include "estimator/odometry/mapper.h"
#include "estimator/tracking/tracker.h"

namespace saccade {

/// When a keyframe is made, and when it comes into force.
struct KeyframeOptions {
  /// d_kf: the camera's way since the last one's begin, as a share of the typical depth.
  double distance = 0.1;
  /// A keyframe is made, too, when less than this share of the last one's edges is in view.
  double min_visible = 0;
  /// From the last event that it is made of to the first that is tracked by it. What is tracked
  /// meanwhile is tracked by the map before, beside the mapping; 0: tracking waits for it.
  double handover_s = 0;
  /// The poses of a keyframe's last seconds may still change with the next.
  double unsettled_s = 0.1;
};

struct OdometryOptions {
  KeyframeOptions keyframe;
  EdgeMapOptions map;
  MappingOptions mapping;
  TrackerOptions tracker;
};

/// A keyframe coming into force.
struct KeyframeChange {
  double made_s = 0;   ///< last event that it was made of
  double taken_s = 0;  ///< first event that is tracked by it
  std::size_t keyframe = 0;
  std::vector<std::size_t> active;  ///< all that make up the map from then on
};

struct OdometryResult {
  std::vector<TrackedPose> poses;
  std::vector<KeyframeChange> changes;
  double tracking_s = 0;  ///< seconds of work
  double mapping_s = 0;
};

/// Visual odometry (thesis chapter 7): the camera is tracked by a map of edges until it has moved
/// on, then the newest events and their poses make the next keyframe. Mapping runs beside tracking
/// on a thread of its own; which events it sees, and from which event on its keyframe is used, is
/// fixed by event time, so that the result does not depend on the threads.
class Odometry {
 public:
  /// `camera` with its lens.
  Odometry(const OdometryOptions& options, const PinholeCamera& camera, std::uint64_t seed);
  ~Odometry();

  /// `start`: the poses that are known at the start, at least two; `events` in order of time. Poses
  /// are found from the last of them on. `progress` is called with the number of events done since
  /// its last call. Throws InputError where the start shows no edges.
  [[nodiscard]] OdometryResult run(std::span<const Event> events, const Trajectory& start,
                                   const std::function<void(std::size_t)>& progress = {});

  [[nodiscard]] const EdgeMap& map() const { return map_; }

  /// Images for people, after run(): of every keyframe that has none, with the poses as last
  /// adjusted; in parallel.
  void add_images(std::span<const Event> events);

 private:
  struct Job;
  void start_from(std::span<const Event> events, const Trajectory& start);
  [[nodiscard]] bool wants_keyframe(const Rigid3& world_from_camera) const;
  void begin_mapping(std::span<const Event> events, double now_s);
  void end_mapping(double now_s, OdometryResult& result);

  OdometryOptions options_;
  PinholeCamera camera_;
  Mapper mapper_;
  EdgeMap map_;
  Tracker tracker_;
  void take_poses(const Mapping& mapping);
  void output(OdometryResult& result) const;

  std::vector<StampedPose> known_;  ///< the start, then what was tracked, as last adjusted
  double settled_until_s_ = 0;
  Rigid3 last_keyframe_at_;  ///< where the camera was when the last one was begun
  double typical_depth_m_ = 1;
  std::unique_ptr<Job> job_;
};

}  // namespace saccade
