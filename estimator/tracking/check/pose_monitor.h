#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/camera.h"
#include "estimator/tracking/check/pose_check.h"
#include "estimator/tracking/tracker.h"

namespace saccade {

/// States for every pose of a tracker the probability that it is right, and from that whether it is
/// lost: every few milliseconds the map is compared with what was measured at the pose (PoseCheck),
/// of that and the pose's sigmas follow log odds (pose_probability.h), whose running mean is the
/// statement. Lost is a pose of a probability below one half, until it has clearly risen again.
/// Causal: a pose is judged by its own events and what was before.
class PoseMonitor {
 public:
  /// `camera` with its lens; `recording` outlives the monitor.
  PoseMonitor(const PinholeCamera& camera, const Recording& recording);

  /// The map from the next pose on; copied.
  void set_map(const MapPoints& map, const Rigid3& world_from_map);

  /// Takes another piece of the recording, which outlives its use: it begins history() events or
  /// more before those of the next pose, or with the recording.
  void set_recording(const Recording& recording) { recording_ = recording; }
  /// Events before those of a pose that may be needed to judge it.
  [[nodiscard]] std::size_t history() const { return check_.events(); }

  /// Sets `evidence`, `probability` and `status` of the next pose, in order of time.
  void judge(TrackedPose& pose);

  /// Forgets the poses before, after the camera was found anew.
  void restart() {
    log_odds_.reset();
    is_lost_ = false;
  }

 private:
  void measure(const TrackedPose& pose);

  PoseCheck check_;
  Recording recording_;
  Rigid3 map_from_world_;
  PoseEvidence evidence_;
  TimeNs checked_ns_ = 0;
  bool is_map_new_ = true;
  std::optional<double> log_odds_;  ///< running mean; nullopt: nothing was judged yet
  bool is_lost_ = false;
};

/// Judges all poses that a tracker found in a recording by one map.
void judge_poses(const PinholeCamera& camera, const Recording& recording, const MapPoints& map,
                 const Rigid3& world_from_map, std::vector<TrackedPose>& poses);

/// Adds a lost pose to each gap in which the camera has probably moved beyond the limits of a loss,
/// at the time at which it does if it goes on as before the gap: an event camera that moves and
/// sees nothing is covered, before a blank wall, or beside the map. One that comes to rest before
/// sees nothing either, and is not lost. `end_ns`: of the recording.
void report_gaps(TimeNs end_ns, std::vector<TrackedPose>& poses);

/// Time since which all poses are lost; nullopt where the last one is not.
[[nodiscard]] std::optional<double> lost_since_s(std::span<const TrackedPose> poses);

}  // namespace saccade
