#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/camera.h"
#include "core/event.h"
#include "core/io/covariance_file.h"
#include "core/trajectory.h"
#include "estimator/edges/path/batch_adjustment.h"
#include "estimator/edges/path/fixed_lag.h"
#include "estimator/odometry/edge_map.h"
#include "estimator/odometry/event_clock.h"
#include "estimator/odometry/mapper.h"
#include "estimator/odometry/start/first_map.h"
#include "estimator/odometry/start/start_trial.h"
#include "estimator/tracking/check/pose_monitor.h"
#include "estimator/tracking/edges/edge_tracker.h"

namespace saccade {

/// When a keyframe is made, when it is taken into the map, and how many make up the map.
struct KeyframeOptions {
  double distance = 0.1;  ///< d_kf, relative to the typical depth (thesis 7)
  double interval_s = 0;  ///< least time from one's begin to the next's
  /// A keyframe is also made where the camera has moved as far as the baseline that the map's depths
  /// rest on, each time for twice as much, until that is `distance`. The interval does not count it,
  /// and is at most a quarter of the time since the start.
  bool doubles_baseline = false;
  /// A keyframe is also made where the camera has turned by this part of its angle of view, whatever
  /// the interval: else a fast turn leaves the map. 0: never.
  double turn = 0;
  double handover_s = 0;         ///< from its newest event to the last that is tracked without it
  double active_window_s = 0.1;  ///< poses of its last seconds may still change with the next
  int active = 1;                ///< K: at most so many make up the map
};

/// Whether the events are worked through, or played as they were recorded.
enum class OdometryMode {
  kOffline,  ///< tracking waits for a keyframe: the result does not depend on the machine
  kOnline    ///< events arrive at the pace of their times; keyframes are taken when ready
};

/// When the camera is searched for at the keyframes: never, when it is lost, or also when the events
/// are inconsistent with the map (EdgeTracker::is_consistent()).
enum class Relocation { kNever, kLost, kInconsistent };

/// Whether path and edges are adjusted together after the last event, and by what (kOffline, where
/// no pose was lost).
enum class BatchMode { kNone, kEvents, kEventsAndImu };

struct OdometryOptions {
  OdometryMode mode = OdometryMode::kOffline;
  /// Of kOnline: a frame whose events are older is dropped with all that have arrived. Larger values
  /// drop less and lag more; 50 ms is the delay of a method over frames at 20 Hz.
  double max_age_ms = 50;
  KeyframeOptions keyframe;
  Relocation relocation = Relocation::kLost;
  MappingOptions mapping;
  EdgeTrackerOptions tracker;
  FixedLagOptions smoothing;
  BatchMode batch_adjustment = BatchMode::kNone;
};

/// A keyframe taken into the map.
struct KeyframeChange {
  double made_s = 0;   ///< last event that it was made of
  double taken_s = 0;  ///< last event that was tracked without it
  std::size_t keyframe = 0;
  std::vector<std::size_t> active;  ///< all that make up the map from then on
};

struct OdometryResult {
  std::vector<TrackedPose> poses;
  StartTrial trial;  ///< a run ends with a trial that is not passed
  std::vector<KeyframeChange> changes;
  double extrapolated_s = 0;  ///< for so long given poses were extrapolated (first_map())
  /// The given poses tell hardly any depth: poses further from them than 2 % of it are lost.
  bool is_scale_guessed = false;
  double tracking_s = 0;  ///< seconds of work
  double mapping_s = 0;
  double check_s = 0;
  // Of adjust().
  double batch_s = 0;
  std::vector<StampedCovariance> covariances;  ///< of the trajectory; none where not determined
  std::optional<InertialAlignment> inertial;   ///< of kEventsAndImu, in the path's unit
  // Of kOnline.
  std::vector<double> latency_ms;  ///< from the arrival of a pose's last event to the pose
  std::size_t dropped_events = 0;
};

/// Visual odometry (thesis chapter 7): the camera is tracked by a map of edges until it has moved
/// on, then the newest events and their poses make the next keyframe. Mapping runs beside tracking
/// on a thread of its own; which events it uses, and from which event on its keyframe is used, is
/// fixed by event time, so that the result does not depend on the threads.
class Odometry {
 public:
  /// `camera` with its lens.
  Odometry(const OdometryOptions& options, const PinholeCamera& camera, std::uint64_t seed);
  ~Odometry();

  /// For tracking.prediction: imu.
  void set_gyroscope(Gyroscope gyroscope);
  /// For kEventsAndImu.
  void set_imu(MountedImu imu) { imu_ = std::move(imu); }

  /// `start`: the poses that are known at the start, at least two; `events` in order of time. Poses
  /// are found from the last of them on; those that were not given are part of the result, too, as
  /// last adjusted. `progress` is called with the number of events done since its last call. Throws
  /// InputError where a start that was given shows no edges; one that was found has its trial.
  [[nodiscard]] OdometryResult run(std::span<const Event> events, const PathEstimate& start,
                                   const std::function<void(std::size_t)>& progress = {});

  [[nodiscard]] const EdgeMap& map() const { return map_; }

  /// The start and what was tracked, as last adjusted; during run() for `progress` alone.
  [[nodiscard]] std::span<const StampedPose> path() const { return path_; }

  /// Whether adjust() is to follow on what run() found.
  [[nodiscard]] bool wants_batch_adjustment() const;

  /// The batch adjustment (batch_adjustment.h) of what run() found of the same events and start:
  /// poses with their sigmas and covariances, and keyframes on the adjusted path. `progress`: as of
  /// adjust_batch().
  void adjust(std::span<const Event> events, const PathEstimate& start, OdometryResult& result,
              const std::function<void(std::size_t)>& progress = {});

  /// Images for people, after run(): of every keyframe that has none, with the poses as last
  /// adjusted; in parallel. `progress` is called, by any thread, with the number of keyframes done
  /// since its last call.
  void add_images(std::span<const Event> events,
                  const std::function<void(std::size_t)>& progress = {});

 private:
  struct Job;
  /// The events of a run and how far it has come.
  struct Stream {
    std::span<const Event> all;
    std::size_t done = 0;  ///< tracked or dropped
    [[nodiscard]] std::span<const Event> rest() const { return all.subspan(done); }
  };

  /// False: it makes no map.
  [[nodiscard]] bool start_from(FirstMap first, OdometryResult& result);
  void take(Keyframe keyframe, const Rigid3& world_from_camera);
  void take_map();
  void await_frame(const EventClock& clock, Stream& stream, OdometryResult& result);
  void add_pose(TrackedPose pose, OdometryResult& result);
  void discard_diverged_poses(const TrackedPose& found, OdometryResult& result);
  [[nodiscard]] std::optional<TrackedPose> relocate();
  [[nodiscard]] double moved_m() const;  ///< since the last keyframe was begun
  [[nodiscard]] double doubling_m() const;
  [[nodiscard]] bool has_doubled_baseline() const;
  [[nodiscard]] bool has_turned() const;
  [[nodiscard]] bool wants_keyframe() const;
  /// After the last event: what was tracked since the last keyframe is adjusted like all before it.
  [[nodiscard]] bool wants_last_keyframe() const;
  [[nodiscard]] bool is_due(double now_s) const;
  [[nodiscard]] Mapping map(std::span<const Event> events, const PathEstimate& path);
  void smooth(const PathEstimate& path, Mapping& mapping);
  void begin_mapping(std::span<const Event> events, double now_s);
  void end_mapping(double now_s, OdometryResult& result);
  void apply_adjusted_poses(const Mapping& mapping);
  void move_keyframes(double from_s);
  void lose_distant_poses(OdometryResult& result) const;
  void output(OdometryResult& result) const;

  OdometryOptions options_;
  BatchAdjustmentOptions batch_;
  FirstMapOptions start_;
  PinholeCamera camera_;
  Mapper mapper_;
  EdgeMap map_;
  FixedLagSmoother smoother_;  ///< of the thread that maps
  EdgeTracker tracker_;
  std::optional<PoseMonitor> monitor_;
  std::vector<StampedPose> path_;  ///< the start, then what was tracked, as last adjusted
  double fixed_until_s_ = 0;
  double given_until_s_ = kNoGivenPoses;
  double held_until_s_ = 0;   ///< poses of the start until then never change: they fix the gauge
  double mapped_from_s_ = 0;  ///< events before are not mapped any more
  std::vector<TimeNs>
      lost_ns_;  ///< times of the poses that the tracker, not their check, says are lost
  double last_search_s_ = -std::numeric_limits<double>::infinity();
  Gyroscope gyroscope_;
  std::optional<MountedImu> imu_;
  StampedPose last_keyframe_;   ///< the camera when the last one was begun
  double interval_from_s_ = 0;  ///< when the last was begun that did not double a baseline
  double baseline_m_ = 0;       ///< that the map's depths rest on, or that was tried
  double typical_depth_m_ = 1;
  bool is_lost_ = false;
  bool is_scale_guessed_ = false;
  std::unique_ptr<Job> job_;
};

}  // namespace saccade
