#pragma once

#include <span>
#include <vector>

#include "core/camera.h"
#include "eval/metrics/metrics.h"
#include "eval/metrics/trajectory/scored_samples.h"

namespace saccade {

/// How far the map lies off in the image when it is drawn with the estimated instead of the true
/// pose: over instants k and map points X_i that are visible from the true pose (in front of it
/// and inside the image; occlusion is not tested),
///   e_ik = | pi(T_est_k^-1 X_i) - pi(T_true_k^-1 X_i) |  [px, undistorted]
/// at most the image diagonal, which is also the error of a point behind the estimated camera, so
/// that no single point at grazing depth decides the sum.
struct ReprojectionSeries {
  std::vector<double> t_s;     ///< instants at which at least one point is visible
  std::vector<double> rms_px;  ///< over the visible points, per instant
  std::vector<double> max_px;
  double rms_all_px = 0;  ///< over all instants and points
};

/// `points_in_world` [m]. At most 2000 instants, evenly picked from `samples`.
[[nodiscard]] ReprojectionSeries reproject(std::span<const Eigen::Vector3f> points_in_world,
                                           const ScoredSamples& samples,
                                           const PinholeCamera& camera);

/// Sets trajectory.reprojection_px.{rms,max,rms_max}: over everything, the worst point, and the
/// worst instant's RMS. null where no point is ever visible.
void set_reprojection(Metrics& metrics, const ReprojectionSeries& series);

}  // namespace saccade
