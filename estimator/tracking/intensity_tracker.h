#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "core/event.h"
#include "core/rigid3.h"
#include "estimator/tracking/event_chunk.h"
#include "estimator/tracking/intensity_map.h"
#include "estimator/tracking/intensity_options.h"
#include "estimator/tracking/level_measurements.h"
#include "estimator/tracking/motion_model.h"
#include "estimator/tracking/tracker.h"

namespace saccade {

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

  [[nodiscard]] std::size_t templates_drawn() const { return measurements_.views_drawn(); }
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
  void restart_levels(float looks);
  void load(std::span<const Event> events, TimeNs t_ns, const Rigid3& map_from_camera);
  [[nodiscard]] TrackedPose track_batch(std::span<const Event> events);
  [[nodiscard]] std::size_t events_per_pose() const;
  [[nodiscard]] Estimate align(const PosePrediction& predicted);
  [[nodiscard]] EventChunk::Motion motion_at(const Rigid3& map_from_camera) const;

  IntensityOptions options_;
  PinholeCamera camera_;  ///< undistorted
  Rigid3 world_from_map_;
  LevelMeasurements measurements_;
  MotionModel motion_;
  TimeNs last_event_ns_ = 0;
  double usual_inliers_ = 0;  ///< running mean while it is tracked; 0: not known
  Evidence judged_;
  int misfits_ = 0;  ///< judgements in a row that it fits worse than usual
  bool is_lost_ = false;
  int attempts_ = 0;  ///< to find the pose again, since it was tracked for long
  int fits_ = 0;      ///< judgements since it was found that it fits
  Rigid3 lost_at_;    ///< the last pose before
  Tracker& edges_;
  TrackTiming timing_;
};

}  // namespace saccade
