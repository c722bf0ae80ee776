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
#include "estimator/odometry/edge_map.h"
#include "estimator/odometry/event_clock.h"
#include "estimator/odometry/mapper.h"
#include "estimator/odometry/start/first_map.h"
#include "estimator/refinement/joint_refinement.h"
#include "estimator/tracking/edges/edge_tracker.h"

namespace saccade {

/// When a keyframe is made, and when it comes into force.
struct KeyframeOptions {
  /// d_kf: the camera's way since the last one's begin, as a share of the typical depth.
  double distance = 0.1;
  /// A keyframe is made, too, when less than this share of the last one's edges is in view.
  double min_visible = 0;
  /// Least time from one's begin to the next's: what mapping costs is bounded by it.
  double interval_s = 0;
  /// From the last event that it is made of to the last that is tracked without it. What is tracked
  /// meanwhile is tracked by the map before, beside the mapping; 0: tracking waits for it.
  double handover_s = 0;
  /// The poses of a keyframe's last seconds may still change with the next.
  double unsettled_s = 0.1;
};

/// Whether the events are worked through, or played as they were recorded.
enum class OdometryMode {
  kOffline,  ///< tracking waits for a keyframe: the result does not depend on the machine
  kOnline    ///< events arrive at the pace of their times; keyframes come into force when ready
};

struct OnlineOptions {
  /// When the events of a frame are as old as that before it is begun, all that have arrived are
  /// dropped [ms].
  double max_age_ms = 50;
};

/// What happens after the camera was lost.
struct RelocationOptions {
  double every_s = 0.01;       ///< it is looked for so often, in the events' time; 0: never
  double looks_back_s = 0.05;  ///< first where it was so long before it was lost
  /// It is looked for, too, where the map explains much less of the frames than usual, though not
  /// so little that the camera is lost (EdgeTracker::fits).
  bool when_unlike = false;
};

/// The whole path and the edges of all keyframes, adjusted together after the last event.
struct LastAdjustment {
  bool use = false;  ///< of kOffline, where no pose was lost
  JointRefinementOptions joint;
};

struct OdometryOptions {
  OdometryMode mode = OdometryMode::kOffline;
  OnlineOptions online;
  KeyframeOptions keyframe;
  RelocationOptions relocation;
  EdgeMapOptions map;
  MappingOptions mapping;
  EdgeTrackerOptions tracker;
  LastAdjustment last;
};

/// A keyframe coming into force.
struct KeyframeChange {
  double made_s = 0;   ///< last event that it was made of
  double taken_s = 0;  ///< last event that was tracked without it
  std::size_t keyframe = 0;
  std::vector<std::size_t> active;  ///< all that make up the map from then on
};

struct OdometryResult {
  std::vector<TrackedPose> poses;
  std::vector<KeyframeChange> changes;
  double carried_s = 0;   ///< for so long given poses were carried on (first_map())
  double tracking_s = 0;  ///< seconds of work
  double mapping_s = 0;
  // Of refine().
  double refinement_s = 0;
  std::vector<StampedCovariance> covariances;  ///< of all poses; none where not determined
  std::optional<InertialAlignment> inertial;   ///< of last.joint.imu, in the path's unit
  // Of kOnline.
  std::vector<double> latency_ms;  ///< from the arrival of a pose's last event to the pose
  std::size_t dropped_events = 0;
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

  /// For tracking.motion.prediction: imu.
  void set_gyroscope(Gyroscope gyroscope);
  /// For last.joint.imu.
  void set_imu(MountedImu imu) { imu_ = std::move(imu); }

  /// `start`: the poses that are known at the start, at least two; `events` in order of time. Poses
  /// are found from the last of them on; those that were not given are part of the result, too, as
  /// last adjusted. `progress` is called with the number of events done since its last call. Throws
  /// InputError where the start shows no edges.
  [[nodiscard]] OdometryResult run(std::span<const Event> events, const KnownPath& start,
                                   const std::function<void(std::size_t)>& progress = {});

  [[nodiscard]] const EdgeMap& map() const { return map_; }

  /// Whether options.last is to be made of what run() found.
  [[nodiscard]] bool wants_refinement(const OdometryResult& result) const;

  /// The last adjustment, of what run() found of the same events and start: poses with their
  /// sigmas and covariances, and keyframes on the refined path. `progress`: as of refine_jointly().
  void refine(std::span<const Event> events, const KnownPath& start, OdometryResult& result,
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

  void start_from(FirstMap first, OdometryResult& result);
  void await_frame(const EventClock& clock, Stream& stream, OdometryResult& result);
  void take_pose(TrackedPose pose, OdometryResult& result);
  void forget_astray(const TrackedPose& found, OdometryResult& result);
  [[nodiscard]] std::optional<TrackedPose> find_again();
  [[nodiscard]] bool wants_keyframe() const;
  [[nodiscard]] bool is_due(double now_s) const;
  void begin_mapping(std::span<const Event> events, double now_s);
  void end_mapping(double now_s, OdometryResult& result);
  void take_mapped_poses(const Mapping& mapping);
  void output(OdometryResult& result) const;

  OdometryOptions options_;
  FirstMapOptions start_;
  PinholeCamera camera_;
  Mapper mapper_;
  EdgeMap map_;
  EdgeTracker tracker_;
  std::vector<StampedPose> known_;  ///< the start, then what was tracked, as last adjusted
  double settled_until_s_ = 0;
  double given_until_s_ = kNothingGiven;
  double mapped_from_s_ = 0;  ///< poses before were lost and found again
  bool is_lost_ = false;
  double last_search_s_ = -std::numeric_limits<double>::infinity();
  Gyroscope gyroscope_;
  std::optional<MountedImu> imu_;
  StampedPose last_keyframe_;  ///< the camera when the last one was begun
  double typical_depth_m_ = 1;
  std::unique_ptr<Job> job_;
};

}  // namespace saccade
