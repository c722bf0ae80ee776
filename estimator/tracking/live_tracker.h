#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "core/event.h"
#include "core/io/dataset/dataset.h"
#include "estimator/tracking/check/pose_monitor.h"
#include "estimator/tracking/track_config.h"
#include "estimator/tracking/track_start.h"
#include "estimator/tracking/tracker.h"

namespace saccade {

/// A tracker that is fed with events as they come. Its poses are those of `saccade run track`,
/// however the events are divided (a Tracker goes on where it was, but for sliding event frames), but
/// for the poses that a run adds in gaps (report_gaps()). Where events of one time are divided the
/// probability of a pose may differ. A tracker that has to find contrast thresholds first waits for
/// Tracker::first_events(). Memory is that of the events that wait for a pose.
class LiveTracker {
 public:
  /// The map is that of `dataset`, for tracking from `start_s` to `end_s`. Throws InputError for what
  /// the dataset lacks, for `method: frames` and for sliding event frames, which need all events.
  LiveTracker(const TrackConfig& config, const Dataset& dataset, double start_s, double end_s);
  LiveTracker(const LiveTracker&) = delete;  // the tracker refers to the world beside it
  LiveTracker& operator=(const LiveTracker&) = delete;

  /// The poses that can be told with the next events, in order of time and not before those of the
  /// last call (InputError otherwise), within the sensor.
  [[nodiscard]] std::vector<TrackedPose> feed(std::span<const Event> events);

  /// The same of events that are written in place: room for the next `count`, all of which are
  /// written before feed() takes them.
  [[nodiscard]] std::span<Event> room(std::size_t count);
  [[nodiscard]] std::vector<TrackedPose> feed();

  /// Events that wait for a pose.
  [[nodiscard]] std::size_t waiting() const { return fed_ - used_; }
  [[nodiscard]] const TrackWorld& world() const { return world_; }

 private:
  [[nodiscard]] std::span<const Event> buffered() const { return std::span(events_).first(end_); }
  void check_new_events() const;
  [[noreturn]] void report_new_events() const;

  TrackConfig config_;
  TrackStart start_;
  TrackWorld world_;
  std::unique_ptr<Tracker> tracker_;
  PoseMonitor monitor_;
  /// Those that wait, behind those that the monitor may need, then new ones; never made smaller, as
  /// making room costs more than filling it.
  Events events_;
  std::size_t used_ = 0;      ///< of events_, by the tracker
  std::size_t fed_ = 0;       ///< of events_, before the new ones
  std::size_t end_ = 0;       ///< of events_, with the new ones
  bool has_begun_ = false;    ///< to be fed
  bool is_tracking_ = false;  ///< has had its first events
};

}  // namespace saccade
