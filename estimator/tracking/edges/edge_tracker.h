#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "estimator/tracking/edges/alignment_pyramid.h"
#include "estimator/tracking/edges/edge_template.h"
#include "estimator/tracking/edges/event_frame.h"
#include "estimator/tracking/edges/event_window.h"
#include "estimator/tracking/edges/template_aligner.h"
#include "estimator/tracking/map_extraction.h"
#include "estimator/tracking/tracker.h"

namespace saccade {

/// The defaults are the accurate setting.
struct EdgeTrackerOptions {
  /// Presets; they also set options without a configuration key, see edge_preset().
  enum class Preset { kAccurate, kFast, kNarrowView, kThesis };

  Preset preset = Preset::kAccurate;
  TemplateOptions templates;
  EventFrameOptions event_frame;
  AlignOptions align;
  MotionModelOptions motion{
      .prediction = MotionModelOptions::Prediction::kConstantVelocity,
      .acceleration_sigma_px = 1000,
  };
  double min_inlier_ratio = 0.55;
};

/// The thesis's accurate (500 samples, 30 iterations) and fast (50 samples, 5 iterations) settings
/// with this project's improvements, one for a narrow field of view and steady motion, and the
/// thesis's method as it was printed.
[[nodiscard]] EdgeTrackerOptions edge_preset(EdgeTrackerOptions::Preset preset);

/// The keys but those of the motion model, which is a section of its own.
void describe(config::Fields& fields, EdgeTrackerOptions& options);

/// The thesis's tracker (chapter 4): a template of the map's edges is aligned to frames of
/// event_map_ratio * n_map events (4.21). Deterministic in `seed`.
class EdgeTracker : public Tracker {
 public:
  /// `camera` may be distorted: events are moved to the undistorted sensor, on which all else runs.
  /// `map` lives in the frame of the reference view and outlives the tracker.
  EdgeTracker(const EdgeTrackerOptions& options, const PinholeCamera& camera, const MapPoints& map,
              const Rigid3& world_from_map, std::uint64_t seed);

  void reset(TimeNs t_ns, const Rigid3& world_from_camera) override {
    reset(t_ns, world_from_camera, 0.2);
  }
  /// From a pose with this standard deviation, as image motion.
  void reset(TimeNs t_ns, const Rigid3& world_from_camera, double sigma_px);

  [[nodiscard]] std::vector<TrackedPose> track(const Recording& recording,
                                               const TrackProgress& progress = {}) override;

  /// Begins with a stream in order of time, which outlives its poses.
  void start(std::span<const Event> events);
  /// The pose of the next frame of the stream; nullopt where too few events are left for one.
  [[nodiscard]] std::optional<TrackedPose> next();

  /// Takes another map from the next frame on, in the frame of the first; `map` outlives the
  /// tracker. Pose and motion go on.
  void set_map(const MapPoints& map);

  /// Moves pose and motion within the map, after the map was adjusted.
  void correct(const Rigid3& map_from_before) { motion_.correct(map_from_before); }

  /// Whether the map explains as much of the last frames as it does on average. Where it does not,
  /// the camera may be elsewhere, at a place that looks a little like this one, or the map at its
  /// end.
  [[nodiscard]] bool is_consistent() const { return inconsistent_frames_ < kLostFrames; }

  /// Whether the last frames in a row fit the map badly or not at all: a single one is noise, and
  /// its few events are found at many other places, too.
  [[nodiscard]] bool is_lost() const { return suspicious_frames_ >= kLostFrames; }

  /// Relocalises with the newest events before the end of the last next(): starts anew from the
  /// candidate pose at which map and frame agree best, if they agree there nearly as well as on
  /// average and much better than where it was tracked, and if that is some pixels elsewhere. nullopt,
  /// and nothing is changed, where they do not.
  [[nodiscard]] std::optional<TrackedPose> relocate(std::span<const Rigid3> world_from_camera);

  /// Events of the next frame.
  [[nodiscard]] std::size_t next_frame_events();
  /// A frame below it is suspicious.
  [[nodiscard]] double min_inlier_ratio() const { return options_.min_inlier_ratio; }
  /// Harmonic mean depth of the visible map [m].
  [[nodiscard]] double typical_depth_m() const { return typical_depth_m_; }
  /// n_map of (4.21): pixels that the map lights in the last template.
  [[nodiscard]] std::size_t lit_pixels() const { return drawer_.lit_pixels(); }
  [[nodiscard]] std::size_t templates_drawn() const { return templates_drawn_; }

 private:
  /// Suspicious frames in a row that make a loss: single ones are noise.
  static constexpr int kLostFrames = 3;

  void prepare_template(const Rigid3& map_from_camera);
  [[nodiscard]] bool template_fits(const Rigid3& map_from_camera) const;
  /// By how much the points of the template move from one camera's image to another's, the root of
  /// the mean square [px]; infinite where one of them is behind a camera, 0 of no points.
  [[nodiscard]] double motion_px(const Rigid3& map_from_a, const Rigid3& map_from_b) const;
  [[nodiscard]] std::size_t events_per_frame() const;
  void draw_frame(TrackedPose& pose);
  [[nodiscard]] AlignResult align(TimeNs t_ns);
  [[nodiscard]] TrackStatus judge(const AlignResult& aligned);
  [[nodiscard]] TrackedPose track_frame();
  void update_motion(const AlignResult& aligned);
  void compare_to_mean_agreement(const AlignResult& aligned);
  void write_evidence(const AlignResult& aligned, TrackedPose& pose) const;

  EdgeTrackerOptions options_;
  PinholeCamera camera_;  ///< undistorted
  std::uint64_t seed_;
  TemplateDrawer drawer_;
  TemplateAligner aligner_;
  AlignmentPyramid pyramid_;
  EventWindow window_;
  EventFrame frame_;
  Rigid3 map_from_template_;
  std::span<const TemplatePoint> points_;
  double typical_depth_m_ = 1;
  BrightnessModel brightness_;  ///< running mean over the frames, which resemble each other
  bool is_brightness_known_ = false;
  std::uint64_t frame_index_ = 0;
  std::size_t templates_drawn_ = 0;
  int suspicious_frames_ = 0;
  double last_agreement_ = 0;    ///< of the last next()
  double mean_agreement_ = 0;    ///< running mean
  int inconsistent_frames_ = 0;  ///< in a row, with much less than the mean
  TrackedPose last_;             ///< of the last next()
};

}  // namespace saccade
