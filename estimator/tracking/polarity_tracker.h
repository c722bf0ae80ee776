#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "core/event.h"
#include "core/rigid3.h"
#include "estimator/tracking/increment_chunk.h"
#include "estimator/tracking/increment_frame.h"
#include "estimator/tracking/increment_template.h"
#include "estimator/tracking/intensity_map.h"
#include "estimator/tracking/map_view.h"
#include "estimator/tracking/motion_model.h"
#include "estimator/tracking/tracker.h"

namespace saccade {

/// How poses are found from the signs of the events.
struct PolarityOptions {
  IntensityMapOptions map{.blur_px = 0};
  int events = 3000;           ///< per pose
  int iterations = 4;          ///< of Gauss-Newton
  bool reversals = true;       ///< see IncrementFrame
  double min_slope = 1;        ///< see IncrementTemplate
  double noise = 0.2;          ///< deviation of a pixel's sum of polarities [thresholds]
  double place_px = 0.2;       ///< of the place where the map shows an increment
  double redraw_px = 4;        ///< the map is drawn anew when the view has moved this far
  double information = 0.01;   ///< of that of independent residuals: neighbouring ones err alike
  double min_agreement = 0.8;  ///< of signs, below which the edges take over; 0.5 is chance
};

/// 6-DoF pose of an event camera against a map of log intensity, by the signs of the events: where
/// the camera moves with velocity V for a time dt the brightness changes by M dt, M = grad L dW/dxi
/// V, and events of that sign follow, so many that their number times the threshold is the change.
/// The pose is sought at which
///   r(u) = E(W(u; pose)) - k M(u),
/// E the sums of polarities of the next events, is smallest, for whichever factor k fits best: the
/// contrast threshold and the length of dt are in it and need not be known. Gauss-Newton (inverse
/// compositional) with Cauchy weights, pulled towards a constant velocity, which also gives V, by
/// the prediction's precision. Where the signs disagree with what is expected - at the start, when
/// V is not known, and where the camera turns back - the edges of the map are followed for a few
/// frames instead. Lost is what they do not fit either. Deterministic; one thread.
class PolarityTracker {
 public:
  /// `camera` may be distorted; `map` and `edges` outlive the tracker. `motion` predicts.
  PolarityTracker(const PolarityOptions& options, const PredictionOptions& motion,
                  const PinholeCamera& camera, const IntensityMap& map, Tracker& edges);

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
  using Poses = std::vector<TrackedPose>;
  std::size_t follow_edges(std::span<const Event> events, Poses& poses);
  void draw_view(const Rigid3& map_from_camera);
  [[nodiscard]] bool track_frame(std::span<const Event> events, Poses& poses);
  [[nodiscard]] Estimate align(const PosePrediction& predicted);
  [[nodiscard]] IncrementChunk::Sums compare(const IncrementPoints& points,
                                             const Rigid3& current_from_template, double gain);

  PolarityOptions options_;
  PinholeCamera camera_;  ///< undistorted
  const IntensityMap& map_;
  MapView view_;
  IncrementTemplate template_;
  IncrementFrame frame_;
  IncrementChunk chunk_;
  MotionModel motion_;
  Tracker& edges_;
  bool has_view_ = false;
  bool by_edges_ = true;  ///< the edges go on: they have not fitted yet
  std::size_t views_drawn_ = 0;
  TrackTiming timing_;
};

}  // namespace saccade
