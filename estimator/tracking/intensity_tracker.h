#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/event.h"
#include "core/rigid3.h"
#include "estimator/tracking/event_chunk.h"
#include "estimator/tracking/intensity_map.h"
#include "estimator/tracking/map_view.h"
#include "estimator/tracking/motion_model.h"
#include "estimator/tracking/pixel_levels.h"
#include "estimator/tracking/tracker.h"

namespace saccade {

/// How poses are found from the log intensity at each event.
struct IntensityOptions {
  IntensityMapOptions map;
  /// Per pose; by default 1000, times (width / 240 px)^1.5 on a wider sensor.
  std::optional<int> events;
  int samples = 1000;           ///< at most so many of them are aligned, evenly spread
  double pixels_per_event = 1;  ///< aligned beside them: pixels between their events
  double least_slope = 0.1;     ///< of the map where such a pixel looks [log units/px]
  bool half_step = true;        ///< a pixel is taken to have gone on by half a threshold
  int iterations = 4;           ///< of Gauss-Newton
  double noise = 0.05;          ///< deviation of a level from the map [log units]
  double place_px = 0.2;        ///< of the place where the map shows it, see EventChunk::Noise
  double correction = 0.15;     ///< least share by which a level is drawn to the map at each event
  double redraw_deg = 1.15;     ///< the map is drawn anew when the view has moved this far
  double inlier_drop = 0.75;    ///< lost below this share of the inlier ratio that is usual
  double silence_px = 2;        ///< lost where the camera should have moved so far without an event
  double information = 0.1;     ///< of that of independent residuals: neighbouring ones err alike
};

/// The part of a sensor's model that the tracker knows.
struct EventContrast {
  double on = 0.2, off = 0.2;  ///< thresholds [log units]
};

/// 6-DoF pose of an event camera against a map of log intensity. An event says what its pixel saw
/// at its instant: the first value plus the thresholds of all its events. The pose is sought at
/// which the map shows the same there:
///   r_k = level_k - L(W(u_k; pose at t_k)),   pose(t) = pose exp((t - t_0) velocity)
/// and beside the events some pixels between theirs, whose levels are known to within a threshold,
/// by Gauss-Newton with Cauchy weights, pulled towards a constant velocity by the prediction's
/// precision. Lost - fewer residuals fit than usual, or no event came although the camera moves -
/// the levels say nothing any more: the edges of the map are sought around the expected pose until
/// they fit, and the levels start anew there. Deterministic; one thread.
class IntensityTracker {
 public:
  /// `camera` may be distorted; `map` and `edges`, which finds the pose again, outlive the tracker.
  IntensityTracker(const IntensityOptions& options, const PredictionOptions& motion,
                   const EventContrast& contrast, const PinholeCamera& camera,
                   const IntensityMap& map, Tracker& edges);

  /// For motion.prediction: imu.
  void set_gyroscope(Gyroscope gyroscope) { motion_.set_gyroscope(std::move(gyroscope)); }

  /// Starts anew from a known pose.
  void reset(TimeNs t_ns, const Rigid3& world_from_camera);

  /// Tracks through `events` in order of time; a rest too short for a pose gives none. `progress`
  /// is called with the number of events done since its last call.
  [[nodiscard]] std::vector<TrackedPose> track(
      std::span<const Event> events, const std::function<void(std::size_t)>& progress = {});

  [[nodiscard]] std::size_t templates_drawn() const { return views_drawn_; }
  [[nodiscard]] const TrackTiming& timing() const { return timing_; }

 private:
  struct Estimate;
  /// Evidence since the last judgement.
  struct Evidence {
    double visible = 0, inliers = 0;  ///< see EventChunk::Sums
    std::size_t events = 0;
  };
  using Poses = std::vector<TrackedPose>;
  [[nodiscard]] std::size_t before_silence(std::span<const Event> events) const;
  [[nodiscard]] bool fits_worse(const EventChunk::Sums& sums, std::size_t events);
  std::size_t relocalise(std::span<const Event> events, Poses& poses);
  void lose();
  [[nodiscard]] Rigid3 guess(TimeNs t_ns) const;
  void draw_view(const Rigid3& map_from_camera);
  void start_levels(float looks);
  [[nodiscard]] TrackedPose track_batch(std::span<const Event> events);
  [[nodiscard]] std::size_t events_per_pose() const;
  void load(std::span<const Event> events, TimeNs t_ns, const EventChunk::Motion& motion);
  /// Some `count` pixels between their events, at the time of the pose.
  void load_pixels(std::size_t count, const EventChunk::Motion& motion);
  void list_steep_pixels();
  /// `pixel`: whose level the alignment will correct.
  void add(const EventMeasurement& measurement, const SeenPlace& seen, std::uint32_t pixel);
  void prefetch(const Event& event, bool is_aligned) const;
  [[nodiscard]] bool find_place(const Eigen::Vector2f& pixel, float time_s,
                                const EventChunk::Motion& motion, SeenPlace& seen) const;
  [[nodiscard]] Estimate align(const PosePrediction& predicted);
  void correct_levels();
  [[nodiscard]] EventChunk::Motion motion_at(const Rigid3& map_from_camera) const;

  IntensityOptions options_;
  PinholeCamera camera_;  ///< undistorted
  UndistortionTable undistortion_;
  const IntensityMap& map_;
  MapView view_;
  PixelLevels levels_;
  float between_trust_;  ///< in a pixel between its events
  MotionModel motion_;
  bool has_view_ = false;
  TimeNs last_event_ns_ = 0;
  double usual_inliers_ = 0;  ///< running mean while it is tracked; 0: not known
  Evidence judged_;
  int misfits_ = 0;  ///< judgements in a row that it fits worse than usual
  bool is_lost_ = false;
  int attempts_ = 0;  ///< to find the pose again, since it was tracked for long
  int fits_ = 0;      ///< judgements since it was found that it fits
  Rigid3 lost_at_;    ///< the last pose before
  Tracker& edges_;
  std::vector<EventChunk> chunks_;
  std::size_t chunk_count_ = 0;
  std::vector<std::uint32_t> loaded_pixels_;  ///< of the events in the chunks, in order
  std::vector<std::uint32_t> steep_pixels_;  ///< where the map is steep, in the view that was drawn
  std::size_t first_pixel_ = 0;              ///< of them that was aligned
  std::size_t views_drawn_ = 0;
  TrackTiming timing_;
};

}  // namespace saccade
