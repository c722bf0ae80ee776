#pragma once

#include <vector>

#include "estimator/tracking/intensity_map.h"
#include "estimator/tracking/map_view.h"
#include "estimator/tracking/pose_solver.h"
#include "estimator/tracking/tracker.h"

namespace saccade {

/// 6-DoF pose of a frame camera against a map of log intensity: the baseline for event cameras. The
/// pose is sought at which the map looks like the frame:
///   r(u) = F(u) - L(W(u; pose)),   J(u) = grad L dW/dxi
/// by Gauss-Newton with Cauchy weights, pulled towards a constant velocity by the prediction's
/// precision. The map is drawn anew for every step; both pictures are averaged over ever smaller
/// squares, over the pixels that both know. The exposure counts as its middle.
class FrameTracker : public Tracker {
 public:
  /// `map` outlives the tracker; frames lie on the undistorted sensor, as the map does.
  FrameTracker(const MotionModelOptions& motion, const IntensityMap& map);

  void reset(TimeNs t_ns, const Rigid3& world_from_camera) override;
  /// One pose for each frame.
  [[nodiscard]] std::vector<TrackedPose> track(const Recording& recording,
                                               const TrackProgress& progress = {}) override;

 private:
  struct Sums;
  [[nodiscard]] TrackedPose track_frame(const GreyFrame& frame);
  [[nodiscard]] PoseEstimate<Sums> align(const GreyFrame& frame, const PosePrediction& predicted);
  /// Images of fewer pixels do not determine a pose.
  [[nodiscard]] int coarsest_level() const;
  void draw(const Rigid3& map_from_camera);
  void average(const ImageF& frame, int square_px);
  [[nodiscard]] Sums compare(const ImageF& frame, int square_px);
  void add_pixel(int x, int y, int square_px, Sums& sums) const;

  const IntensityMap& map_;
  MapView view_;
  ImageF rendered_;  ///< the map at the view's pose; NaN where it is not visible
  /// Means of the frame and of the rendered map over squares; NaN where less than half of a square
  /// is known to both.
  ImageF mean_frame_, mean_map_;
};

}  // namespace saccade
