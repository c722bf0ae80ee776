#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "core/event.h"
#include "core/rigid3.h"
#include "estimator/tracking/coarse_levels.h"
#include "estimator/tracking/edge_template.h"
#include "estimator/tracking/event_frame.h"
#include "estimator/tracking/event_window.h"
#include "estimator/tracking/map_extraction.h"
#include "estimator/tracking/motion_model.h"
#include "estimator/tracking/template_aligner.h"

namespace saccade {

/// When a pose is called lost.
struct LostOptions {
  double min_inlier_ratio = 0.55;  ///< 0.5 is what an unrelated template reaches
  int frames = 3;                  ///< that many frames in a row below it
};

/// Everything of the tracker that does not depend on where its input comes from.
struct TrackerOptions {
  TemplateOptions templates;
  EventFrameOptions event_frame;
  AlignOptions align;
  PredictionOptions motion;
  LostOptions lost;
};

/// kRelocalised: the first pose after having been lost.
enum class TrackStatus { kOk, kLost, kRelocalised };

/// One pose with its evidence.
struct TrackedPose {
  TimeNs t_ns = 0;      ///< mean time of the frame's events
  TimeNs first_ns = 0;  ///< its first event
  TimeNs last_ns = 0;   ///< its last event
  Rigid3 world_from_camera;
  TrackStatus status = TrackStatus::kOk;
  int iterations = 0;
  double inlier_ratio = 0;  ///< see AlignResult
  double residual = 0;
  double position_sigma_m = 0;    ///< standard deviation as the residuals let expect it
  double rotation_sigma_rad = 0;  ///< the same

  /// Takes both from a covariance (v, w) [m, rad].
  void set_sigmas(const Matrix6& covariance) {
    position_sigma_m = std::sqrt(covariance.topLeftCorner<3, 3>().trace());
    rotation_sigma_rad = std::sqrt(covariance.bottomRightCorner<3, 3>().trace());
  }
};

/// Seconds that went into each stage since the last reset.
struct TrackTiming {
  double template_s = 0;
  double event_frame_s = 0;
  double align_s = 0;

  TrackTiming& operator+=(const TrackTiming& other) {
    template_s += other.template_s;
    event_frame_s += other.event_frame_s;
    align_s += other.align_s;
    return *this;
  }
};

/// 6-DoF pose of an event camera against a known map (thesis chapter 4): a pose for every
/// ratio * template pixels events. Deterministic in `seed`; one thread.
class Tracker {
 public:
  /// `camera` may be distorted: events are moved to the undistorted sensor, on which all else runs.
  /// `map` lives in the frame of the reference view and outlives the tracker.
  Tracker(const TrackerOptions& options, const PinholeCamera& camera, const MapPoints& map,
          const Rigid3& world_from_map, std::uint64_t seed);

  /// For motion.prediction: imu.
  void set_gyroscope(Gyroscope gyroscope) { motion_.set_gyroscope(std::move(gyroscope)); }

  /// Starts anew from a pose that is known to `deviation_px`, as image motion.
  void reset(TimeNs t_ns, const Rigid3& world_from_camera, double deviation_px = 0.2);

  /// Takes another map from the next frame on, in the frame of the first; `map` outlives the
  /// tracker. Pose and motion go on.
  void set_map(const MapPoints& map);

  /// Moves pose and motion within the map: what was tracked so far stands elsewhere.
  void correct(const Rigid3& map_from_before) { motion_.correct(map_from_before); }

  /// Whether the map explains of the last frames as much as it usually does. Where it does not, the
  /// camera may be elsewhere, at a place that looks a little like this one, or the map at its end.
  [[nodiscard]] bool fits() const { return unlike_frames_ < options_.lost.frames; }

  /// Looks for the camera where it may be, with the newest events before the end of the last
  /// next(): starts anew from the place at which map and frame agree best, if they agree there
  /// nearly as well as usual and much better than where it was tracked. nullopt, and nothing is
  /// changed, where they do not.
  [[nodiscard]] std::optional<TrackedPose> relocate(std::span<const Rigid3> world_from_camera);

  /// Begins with a stream in order of time, which outlives its poses.
  void start(std::span<const Event> events);
  /// The pose of the next frame of the stream; nullopt where too few events are left for one.
  [[nodiscard]] std::optional<TrackedPose> next();

  /// Tracks through `events` in order of time; a rest too short for a frame gives no pose.
  /// `progress` is called with the number of events done since its last call.
  [[nodiscard]] std::vector<TrackedPose> track(
      std::span<const Event> events, const std::function<void(std::size_t)>& progress = {});

  /// That the next frame takes.
  [[nodiscard]] std::size_t next_frame_events();
  /// Below it a frame is suspicious.
  [[nodiscard]] double least_inlier_ratio() const { return options_.lost.min_inlier_ratio; }
  /// Where the camera is, how it moves, and how well that is known; in the map's frame.
  [[nodiscard]] const MotionModel& motion() const { return motion_; }
  /// Of what is seen of the map [m].
  [[nodiscard]] double typical_depth_m() const { return typical_depth_m_; }
  /// Pixels that the map lights in the last template.
  [[nodiscard]] std::size_t lit_pixels() const { return drawer_.lit_pixels(); }
  [[nodiscard]] std::size_t templates_drawn() const { return templates_drawn_; }
  [[nodiscard]] const TrackTiming& timing() const { return timing_; }

 private:
  void prepare_template(const Rigid3& map_from_camera);
  [[nodiscard]] bool template_fits(const Rigid3& map_from_camera) const;
  [[nodiscard]] std::size_t events_per_frame() const;
  void draw_frame(TrackedPose& pose);
  [[nodiscard]] AlignResult align(TimeNs t_ns);
  [[nodiscard]] TrackStatus judge(const AlignResult& aligned);
  [[nodiscard]] TrackedPose track_frame();
  void take(const AlignResult& aligned);
  void compare_to_usual(const AlignResult& aligned);
  void write_evidence(const AlignResult& aligned, TrackedPose& pose) const;

  TrackerOptions options_;
  PinholeCamera camera_;  ///< undistorted
  Rigid3 world_from_map_;
  std::uint64_t seed_;
  TemplateDrawer drawer_;
  TemplateAligner aligner_;
  CoarseLevels coarse_;
  EventWindow window_;
  EventFrame frame_;
  MotionModel motion_;
  Rigid3 map_from_template_;
  std::span<const TemplatePoint> points_;
  double typical_depth_m_ = 1;
  BrightnessModel brightness_;  ///< running mean over the frames, which resemble each other
  bool is_brightness_known_ = false;
  std::uint64_t frame_index_ = 0;
  std::size_t templates_drawn_ = 0;
  int suspicious_frames_ = 0;
  double last_agreement_ = 0;   ///< of the last next()
  double usual_agreement_ = 0;  ///< running mean
  int unlike_frames_ = 0;       ///< in a row, with much less than the usual
  TrackedPose last_;            ///< of the last next()
  TrackTiming timing_;
};

}  // namespace saccade
