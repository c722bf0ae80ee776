#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/event.h"
#include "core/rigid3.h"
#include "estimator/tracking/check/pose_monitor.h"
#include "estimator/tracking/track_config.h"
#include "estimator/tracking/tracker.h"

namespace saccade {

/// Whether the tracker goes on where it was when it is given events piece by piece: all do, but for
/// sliding event frames and what takes frames.
[[nodiscard]] bool is_fed_in_pieces(const TrackConfig& config);

/// Gives a tracker events as they come and judges its poses: with finish() those of the whole recording
/// at once, however the events are divided, but that the probability of a pose may differ where
/// events of one time are. Memory is that of the events that wait for a pose.
class TrackerFeed {
 public:
  /// `tracker` of `world`, which both outlive the feed; it is reset to the pose by the first event.
  TrackerFeed(Tracker& tracker, const TrackWorld& world, const Rigid3& world_from_camera);

  /// Room for the next `count` events, which are written there before feed() takes them: in order of
  /// time, not before earlier ones, within the sensor (contract).
  [[nodiscard]] std::span<Event> room(std::size_t count);
  /// The poses that can be told with the events in room(), in order of time. A tracker that has to
  /// find contrast thresholds first waits for Tracker::first_events().
  [[nodiscard]] std::vector<TrackedPose> feed();
  /// When no more events come: the poses that can be told with those that wait.
  [[nodiscard]] std::vector<TrackedPose> finish();

  /// Events that wait for a pose.
  [[nodiscard]] std::size_t waiting() const { return fed_ - used_; }
  /// Time that went into judging poses [s].
  [[nodiscard]] double check_s() const { return check_s_; }

 private:
  [[nodiscard]] std::vector<TrackedPose> track_waiting(bool is_complete);

  Tracker& tracker_;
  Rigid3 world_from_camera_;  ///< at the start
  PoseMonitor monitor_;
  /// Those that wait, behind those that the monitor may need, then new ones; never made smaller, as
  /// making room costs more than filling it.
  Events events_;
  std::size_t used_ = 0;      ///< of events_, by the tracker
  std::size_t fed_ = 0;       ///< of events_, before the new ones
  std::size_t end_ = 0;       ///< of events_, with the new ones
  bool has_begun_ = false;    ///< to be fed
  bool is_tracking_ = false;  ///< has had its first events
  double check_s_ = 0;
};

}  // namespace saccade
