#pragma once

#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/event.h"
#include "core/image.h"
#include "core/rigid3.h"
#include "estimator/tracking/check/pose_evidence.h"
#include "estimator/tracking/event_contrast.h"
#include "estimator/tracking/motion_model.h"

namespace saccade {

/// kRelocalised: a pose found by EdgeTracker::relocate(). Trackers that search by themselves report
/// kLost, then kOk.
enum class TrackStatus { kOk, kLost, kRelocalised };

/// One pose with its evidence.
struct TrackedPose {
  TimeNs t_ns = 0;      ///< mean time of the pose's events
  TimeNs first_ns = 0;  ///< its first event
  TimeNs last_ns = 0;   ///< its last event
  Rigid3 world_from_camera;
  TrackStatus status = TrackStatus::kOk;
  bool is_gap =
      false;  ///< no pose: from then on the last one does not hold any more (report_gaps())
  int iterations = 0;
  double inlier_ratio = 0;  ///< measurements that agree with the map, 0..1
  double residual = 0;      ///< root mean square, in the method's unit
  double position_sigma_m = 0;
  double rotation_sigma_rad = 0;
  /// That it is within 5 % of the depth and 5 degrees of the truth, and what says so; of a
  /// PoseMonitor. NaN: not judged.
  double probability = std::numeric_limits<double>::quiet_NaN();
  PoseEvidence evidence;

  /// Takes both standard deviations from a covariance (v, w) [m, rad].
  void set_sigmas(const Matrix6& covariance) {
    position_sigma_m = std::sqrt(covariance.topLeftCorner<3, 3>().trace());
    rotation_sigma_rad = std::sqrt(covariance.bottomRightCorner<3, 3>().trace());
  }
};

/// Seconds that went into each stage since the last reset.
struct TrackTiming {
  double view_s = 0;  ///< drawing the map: its template, or its view
  double load_s = 0;  ///< preparing the measurements: an event frame, or the events' residuals
  double align_s = 0;
};

/// Log intensity of a pixel that shows nothing.
inline constexpr float kUnknownLogIntensity = std::numeric_limits<float>::quiet_NaN();

/// What a frame camera delivered at one time, on the undistorted sensor.
struct GreyFrame {
  TimeNs t_ns = 0;       ///< the middle of the exposure
  ImageF log_intensity;  ///< ln(eps + I); kUnknownLogIntensity where the pixel shows nothing
};

/// What is tracked, in order of time: events, or the frames of `method: frames`.
struct Recording {
  std::span<const Event> events = {};
  std::span<const GreyFrame> frames = {};
  bool is_complete = true;  ///< nothing comes after it; otherwise poses may wait for more
};

/// Called with the number of measurements done since its last call.
using TrackProgress = std::function<void(std::size_t)>;

/// 6-DoF pose of a camera against a known map (thesis chapter 4): what the methods share. All
/// are deterministic and use one thread. Lost tracking is a status of the pose, never an error.
class Tracker {
 public:
  /// `focal_px` converts image motion into angles; `world_from_map`: pose of the map's frame.
  Tracker(const MotionModelOptions& motion, double focal_px, const Rigid3& world_from_map)
      : world_from_map_(world_from_map), motion_(motion, focal_px) {}
  virtual ~Tracker() = default;

  /// The camera's gyroscope, for motion.prediction: imu.
  void set_gyroscope(Gyroscope gyroscope) { motion_.set_gyroscope(std::move(gyroscope)); }

  /// Starts anew from a known pose.
  virtual void reset(TimeNs t_ns, const Rigid3& world_from_camera) = 0;

  /// The poses of a recording that begins at the time of reset(), or goes on after the last event
  /// that `progress` was told of; too few events at its end give none.
  [[nodiscard]] virtual std::vector<TrackedPose> track(const Recording& recording,
                                                       const TrackProgress& progress = {}) = 0;

  /// So many events are to be given to the first track() after reset() at once, where there are as
  /// many.
  [[nodiscard]] virtual std::size_t first_events() const { return 0; }

  /// The contrast thresholds that track() found, where it needed them and nobody stated them.
  [[nodiscard]] virtual std::optional<EventContrast> found_contrast() const { return std::nullopt; }

  /// Where the camera is, how it moves, and how well that is known; in the map's frame.
  [[nodiscard]] const MotionModel& motion() const { return motion_; }
  [[nodiscard]] const TrackTiming& timing() const { return timing_; }

 protected:
  Tracker(const Tracker&) = default;
  Tracker& operator=(const Tracker&) = default;

  /// Writes the motion model's pose and its standard deviations.
  void write_pose(TrackedPose& pose) const {
    pose.world_from_camera = world_from_map_ * motion_.pose();
    pose.set_sigmas(motion_.covariance());
  }

  Rigid3 world_from_map_;
  MotionModel motion_;
  TrackTiming timing_;
};

}  // namespace saccade
