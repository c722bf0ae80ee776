#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "core/camera.h"
#include "core/image.h"
#include "core/rigid3.h"
#include "estimator/tracking/grey_frames.h"
#include "estimator/tracking/intensity_map.h"
#include "estimator/tracking/map_view.h"
#include "estimator/tracking/motion_model.h"
#include "estimator/tracking/tracker.h"

namespace saccade {

/// How poses are found from grey frames.
struct FrameTrackOptions {
  int samples = 10000;       ///< most pixels of a frame that are compared, evenly spread
  int levels = 5;            ///< from means over 2^(levels - 1) pixels square down to single ones
  int iterations = 12;       ///< of Gauss-Newton, on each level
  double noise = 0.05;       ///< deviation of a level from the map [log units]
  double place_px = 0.3;     ///< of the place where the map shows it
  double information = 0.1;  ///< of that of independent residuals: neighbouring ones err alike
  double min_inliers = 0.7;  ///< with a smaller share of pixels that agree the pose is lost
};

/// 6-DoF pose of a frame camera against a map of log intensity: the baseline for event cameras. The
/// pose is sought at which the map looks like the frame:
///   r(u) = F(u) - L(W(u; pose)),   J(u) = grad L dW/dxi
/// by Gauss-Newton with Cauchy weights, pulled towards a constant velocity by the prediction's
/// precision. The map is drawn anew for every step; both pictures are averaged over ever smaller
/// squares, over the pixels that both know. The exposure counts as its middle. Deterministic; one
/// thread.
class FrameTracker {
 public:
  /// `map` outlives the tracker; frames lie on the undistorted sensor, as the map does.
  FrameTracker(const FrameTrackOptions& options, const PredictionOptions& motion,
               const IntensityMap& map);

  /// Starts anew from a known pose.
  void reset(TimeNs t_ns, const Rigid3& world_from_camera);

  /// One pose for each of `frames`, in order of time. `progress` is called with the number of
  /// frames done since its last call.
  [[nodiscard]] std::vector<TrackedPose> track(
      std::span<const GreyFrame> frames, const std::function<void(std::size_t)>& progress = {});

  [[nodiscard]] const TrackTiming& timing() const { return timing_; }

 private:
  struct Sums;
  struct Estimate;
  /// The frame and what the map shows at the estimated pose, as means over squares.
  struct Pictures {
    int square_px = 1;
    ImageF frame, map;  ///< NaN where less than half of a square is known to both
  };
  [[nodiscard]] TrackedPose track_frame(const GreyFrame& frame);
  [[nodiscard]] Estimate align(const GreyFrame& frame, const PosePrediction& predicted);
  /// Pictures of fewer pixels do not determine a pose.
  [[nodiscard]] int coarsest_level() const;
  void draw(const Rigid3& map_from_camera);
  void average(const ImageF& frame, int square_px);
  [[nodiscard]] Sums compare(const ImageF& frame, int square_px);
  void add_pixel(int x, int y, Sums& sums) const;

  FrameTrackOptions options_;
  const IntensityMap& map_;
  MapView view_;
  ImageF shown_;  ///< what the map shows at the view's pose; NaN where nothing is known
  Pictures pictures_;
  MotionModel motion_;
  TrackTiming timing_;
};

}  // namespace saccade
