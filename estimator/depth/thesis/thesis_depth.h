#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/camera.h"
#include "core/config/fields.h"
#include "estimator/depth/depth_estimator.h"
#include "estimator/depth/thesis/depth_filter.h"
#include "estimator/depth/thesis/epipolar_search.h"

namespace saccade {

struct ThesisDepthOptions {
  double events_per_px = 0.28;  ///< thesis section 5.4
  double max_sigma = 0.035;
  std::optional<double> initial_depth_m;
};

void describe(config::Fields& fields, ThesisDepthOptions& options);

/// The thesis's depth estimation (chapter 5). The events around the reference time make the
/// reference frame; its keypoints are searched in all other frames of the window, from the nearest
/// in time to the farthest, and each match updates the keypoint's belief about its inverse depth.
/// Keypoints must be visible in the reference frame, and the camera must move along a nearly
/// constant direction, since an edge's events depend on the direction of the motion.
class ThesisDepth : public DepthEstimator {
 public:
  /// `mean_depth_m`: of the scene, > 0.
  ThesisDepth(const ThesisDepthOptions& options, const DepthLimits& limits,
              const PinholeCamera& camera, double mean_depth_m);

  [[nodiscard]] DepthResult estimate(const ViewWindow& window) const override;

 private:
  struct Keypoint;
  [[nodiscard]] std::vector<Keypoint> start_keypoints(const ImageF& reference) const;
  /// By a frame whose camera is at `centre`, from that of the reference frame in its axes [m].
  void update(const ImageF& frame, const Eigen::Vector3d& centre, Keypoint& keypoint) const;
  [[nodiscard]] std::size_t events_per_frame() const;
  [[nodiscard]] bool is_converged(const DepthBelief& belief) const;

  ThesisDepthOptions options_;
  DepthLimits limits_;
  PinholeCamera camera_;  ///< undistorted
  UndistortionTable undistortion_;
  double initial_depth_m_;
};

}  // namespace saccade
