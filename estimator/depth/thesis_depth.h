#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/camera.h"
#include "estimator/depth/depth_estimator.h"
#include "estimator/depth/depth_filter.h"
#include "estimator/depth/epipolar_search.h"
#include "estimator/depth/grid_keypoints.h"
#include "estimator/depth/outlier_removal.h"

namespace saccade {

struct FilterOptions {
  double error_px = 0.7;       ///< of a match along the epipolar line: tau = error_px / |du/drho|
  double prior_inliers = 10;   ///< a of a new keypoint
  double prior_outliers = 10;  ///< b
  double converged = 0.035;    ///< a point counts when sigma / mean falls below
  double min_inlier_probability = 0.5;  ///< ... and a / (a + b) is above
};

struct ThesisDepthOptions {
  double events_per_px = 0.28;  ///< of an event frame, per pixel of the sensor
  KeypointOptions keypoints;
  SearchOptions search;
  FilterOptions filter;
  OutlierOptions outliers;
  std::optional<double> initial_depth_m;  ///< where keypoints start; default: `mean_depth_m`
};

/// The thesis's depth estimation (chapter 5). The events around the reference time make the
/// reference frame, its keypoints are searched in all other frames of the window, from the nearest
/// in time to the farthest, and each match updates the keypoint's belief about its inverse depth.
/// Keypoints must be visible in the reference frame, and the motion must leave its edges alike.
class ThesisDepth : public DepthEstimator {
 public:
  /// `mean_depth_m`: of the scene, > 0.
  ThesisDepth(const ThesisDepthOptions& options, const DepthLimits& limits,
              const PinholeCamera& camera, double mean_depth_m);

  [[nodiscard]] DepthResult estimate(const ViewWindow& window) const override;

 private:
  struct Keypoint;
  struct Frame;
  [[nodiscard]] std::vector<Keypoint> start_keypoints(const ImageF& reference) const;
  void update(const Frame& frame, std::vector<Keypoint>& keypoints) const;
  void update(const Frame& frame, Keypoint& keypoint) const;
  [[nodiscard]] std::size_t events_per_frame() const;
  [[nodiscard]] bool is_converged(const DepthBelief& belief) const;

  ThesisDepthOptions options_;
  DepthLimits limits_;
  PinholeCamera camera_;  ///< undistorted
  UndistortionTable undistortion_;
  double initial_depth_m_;
};

}  // namespace saccade
