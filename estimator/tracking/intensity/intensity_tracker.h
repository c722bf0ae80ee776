#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "estimator/tracking/edges/edge_fallback.h"
#include "estimator/tracking/intensity/event_residual_batch.h"
#include "estimator/tracking/intensity/intensity_options.h"
#include "estimator/tracking/intensity/log_intensity_residuals.h"
#include "estimator/tracking/intensity_map.h"
#include "estimator/tracking/tracker.h"

namespace saccade {

/// 6-DoF pose of an event camera against a map of log intensity. At the instant of an event its
/// pixel's log intensity is known: the first value plus the thresholds of all its events. The pose
/// is sought at which the map shows the same there:
///   r_k = l_k - L(W(u_k; pose at t_k)),   pose(t) = pose exp((t - t_0) velocity)
/// with one observation of each pixel that fired, and no-event constraints of some others, by
/// Gauss-Newton with Cauchy weights over the variances of pixel and map, and the prediction's
/// precision as a prior. It is lost where fewer residuals than on average are inliers, or no event
/// came although the camera moves: the pixels' state is worthless then, the edges of the map are
/// sought around the expected pose until they fit, and the pixels start anew there.
class IntensityTracker : public Tracker {
 public:
  /// `camera` may be distorted; `map` outlives the tracker, `edges` finds the pose again. `contrast`:
  /// nullopt where nobody states it; it is learned from the start of the recording then.
  IntensityTracker(const IntensityOptions& options, const MotionModelOptions& motion,
                   const std::optional<EventContrast>& contrast, const PinholeCamera& camera,
                   const IntensityMap& map, EdgeTracker edges);

  void reset(TimeNs t_ns, const Rigid3& world_from_camera) override;
  [[nodiscard]] std::vector<TrackedPose> track(const Recording& recording,
                                               const TrackProgress& progress = {}) override;

  [[nodiscard]] std::size_t first_events() const override {
    return knows_contrast_ ? 0 : learning_events();
  }
  [[nodiscard]] std::optional<EventContrast> found_contrast() const override {
    return knows_contrast_ ? std::nullopt : std::optional(residuals_.contrast());
  }
  [[nodiscard]] std::size_t views_drawn() const { return residuals_.views_drawn(); }

 private:
  using Sums = EventResidualBatch::Sums;
  using Poses = std::vector<TrackedPose>;

  /// So many tell thresholds to some percent.
  [[nodiscard]] std::size_t learning_events() const;
  /// From the first events, at the poses that the edges of the map tell.
  void learn_contrast(std::span<const Event> events);
  void learn_from(std::span<const Event> events, const TrackedPose& before, const TrackedPose& pose,
                  const TrackedPose& after);
  void start_at(TimeNs t_ns, const Rigid3& map_from_camera);
  /// Tracks the next batch, or searches; how many events that took, nullopt: too few are left.
  [[nodiscard]] std::optional<std::size_t> track_next(const Recording& recording, Poses& poses);
  [[nodiscard]] std::size_t events_before_gap(std::span<const Event> events) const;
  [[nodiscard]] bool fits_worse(const Sums& sums, std::size_t events);
  std::size_t relocate(const Recording& recording, Poses& poses);
  void lose();
  [[nodiscard]] Rigid3 candidate_pose(TimeNs t_ns) const;
  void restart_pixels(float sigma);
  void load(std::span<const Event> events, TimeNs t_ns, const Rigid3& map_from_camera);
  [[nodiscard]] TrackedPose track_batch(std::span<const Event> events);
  /// Of the camera's motion at the typical depth [px/s].
  [[nodiscard]] double image_speed_px() const {
    return motion_.speed_px(residuals_.typical_depth_m());
  }
  /// So many of the next events are a batch; 0: there are too few.
  [[nodiscard]] std::size_t next_batch(std::span<const Event> events);
  [[nodiscard]] PoseEstimate<Sums> align(const PosePrediction& predicted);
  [[nodiscard]] EventResidualBatch::Motion motion_at(const Rigid3& map_from_camera) const;

  IntensityOptions options_;
  PinholeCamera camera_;  ///< undistorted
  bool knows_contrast_;
  bool has_learned_ = false;  ///< the contrast, since reset()
  LogIntensityResiduals residuals_;
  EdgeFallback fallback_;
  TimeNs last_event_ns_ = 0;
  double mean_inlier_ratio_ = 0;  ///< running mean while it is tracked; 0: not known
  Sums pending_sums_;             ///< since the inlier ratio was last compared with its mean
  std::size_t pending_events_ = 0;
  int low_inlier_batches_ = 0;  ///< comparisons in a row with a ratio well below the mean
  std::vector<std::uint32_t> last_batch_;  ///< of each pixel, with an event of it
  std::uint32_t batch_ = 0;
  bool is_lost_ = false;
  int candidates_tried_ = 0;  ///< poses from which it was searched, since it was tracked for long
  int good_batches_ = 0;      ///< comparisons with a normal ratio since it was found again
  Rigid3 lost_at_;            ///< the last pose before
};

}  // namespace saccade
