#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/config/fields.h"
#include "estimator/tracking/edges/edge_fallback.h"
#include "estimator/tracking/intensity_map.h"
#include "estimator/tracking/map_view.h"
#include "estimator/tracking/polarity/increment_frame.h"
#include "estimator/tracking/polarity/increment_residual_batch.h"
#include "estimator/tracking/polarity/increment_template.h"
#include "estimator/tracking/pose_solver.h"
#include "estimator/tracking/tracker.h"

namespace saccade {

/// How poses are found from the signs of the events.
struct PolarityOptions {
  int events = 3000;
  bool reversals = true;  ///< see IncrementFrame
};

void describe(config::Fields& fields, PolarityOptions& options);

/// 6-DoF pose of an event camera against a map of log intensity, by the signs of the events: where
/// the camera moves with velocity V for a time dt the brightness changes by M dt, M = grad L dW/dxi
/// V, and events of that sign follow, so many that their number times the threshold is the change.
/// The pose is sought at which
///   r(u) = E(W(u; pose)) - k M(u),
/// E the sums of polarities of the next events, is smallest, for whichever factor k fits best: the
/// contrast threshold and the length of dt are in it and need not be known. Gauss-Newton (inverse
/// compositional) with Cauchy weights, pulled towards a constant velocity, which also gives V, by
/// the prediction's precision. Where the signs disagree with what is expected - at the start, when
/// V is not known, and where the camera reverses - the edges of the map are followed for a few
/// frames instead. Lost is what they do not fit either.
class PolarityTracker : public Tracker {
 public:
  /// `camera` may be distorted; `map` outlives the tracker. `motion` predicts.
  PolarityTracker(const PolarityOptions& options, const MotionModelOptions& motion,
                  const PinholeCamera& camera, const IntensityMap& map, EdgeTracker edges);

  void reset(TimeNs t_ns, const Rigid3& world_from_camera) override;
  [[nodiscard]] std::vector<TrackedPose> track(const Recording& recording,
                                               const TrackProgress& progress = {}) override;

  [[nodiscard]] std::size_t views_drawn() const { return views_drawn_; }

 private:
  using Sums = IncrementResidualBatch::Sums;
  using Poses = std::vector<TrackedPose>;

  std::size_t follow_edges(const Recording& recording, Poses& poses);
  void draw_view(const Rigid3& map_from_camera);
  [[nodiscard]] bool track_frame(std::span<const Event> events, Poses& poses);
  [[nodiscard]] PoseEstimate<Sums> align(const PosePrediction& predicted);
  [[nodiscard]] Sums compare(const IncrementPoints& points, const Rigid3& current_from_template,
                             double gain);

  PolarityOptions options_;
  PinholeCamera camera_;  ///< undistorted
  const IntensityMap& map_;
  MapView view_;
  IncrementTemplate template_;
  IncrementFrame frame_;
  IncrementResidualBatch batch_;
  EdgeFallback fallback_;
  bool has_view_ = false;
  bool by_edges_ = true;  ///< the edges go on: they have not fitted yet
  std::size_t views_drawn_ = 0;
};

}  // namespace saccade
