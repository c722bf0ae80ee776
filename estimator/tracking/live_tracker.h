#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/event.h"
#include "core/io/dataset/dataset.h"
#include "estimator/tracking/track_config.h"
#include "estimator/tracking/track_start.h"
#include "estimator/tracking/tracker.h"
#include "estimator/tracking/tracker_feed.h"

namespace saccade {

/// A tracker that is fed with events as they come (TrackerFeed), which are checked. Its poses are
/// those of `saccade run track`, those of finish() included, but for what a run adds in gaps
/// (report_gaps()).
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

  /// When no more events come: the poses that can be told with those that wait.
  [[nodiscard]] std::vector<TrackedPose> finish() { return feed_.finish(); }

  /// Events that wait for a pose.
  [[nodiscard]] std::size_t waiting() const { return feed_.waiting(); }
  [[nodiscard]] const TrackWorld& world() const { return world_; }

 private:
  [[nodiscard]] bool is_good(const Event& event, TimeNs last_ns) const;
  void check_new_events() const;
  [[noreturn]] void report_new_events() const;

  TrackConfig config_;
  TrackStart start_;
  TrackWorld world_;
  std::unique_ptr<Tracker> tracker_;
  TrackerFeed feed_;
  std::span<const Event> new_events_;  ///< in the room of feed_
  std::optional<TimeNs> last_ns_;      ///< of those that were fed
};

}  // namespace saccade
