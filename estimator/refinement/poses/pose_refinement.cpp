#include "estimator/refinement/poses/pose_refinement.h"

#include <array>
#include <cmath>

#include "estimator/edges/least_squares/path_covariance.h"
#include "estimator/refinement/poses/event_run_residuals.h"
#include "estimator/refinement/poses/increment_residuals.h"

namespace saccade {
namespace {

/// Rounds of finding what the path of before saw, and adjusting the path to it.
template <class Residuals>
void refine_by(Residuals& residuals, const PoseRefinementOptions& options, RefinedPath& path) {
  for (int i = 0; i < options.rounds; ++i) {
    PathProblem problem(path.map_from_camera);
    residuals.add_to(problem);
    problem.solve(PoseRefinementOptions::kIterations, path.costs);
    if (i + 1 == options.rounds)
      static_cast<PathEvidence&>(path) = problem.judge(PoseRefinementOptions::kInformationRatio);
    path.map_from_camera = problem.adjusted();
  }
}

}  // namespace

Matrix6 RefinedPath::covariance_at(double t_s) const {
  const SplineKnots::LocalBasis basis = map_from_camera.knots.at(t_s);
  std::array<Rigid3, 4> controls;
  for (std::size_t k = 0; k < 4; ++k) controls[k] = map_from_camera.poses[basis.first + k];
  const PoseOverControls pose = pose_over(basis, controls);
  const Eigen::Matrix3d camera_from_map = pose.world_from_body.rotation_matrix().transpose();
  Eigen::Matrix<double, 6, 24> by_controls = Eigen::Matrix<double, 6, 24>::Zero();
  for (Eigen::Index k = 0; k < 4; ++k) {
    by_controls.block<3, 3>(0, 6 * k) = basis.weight[k] * camera_from_map;
    by_controls.block<3, 3>(3, 6 * k + 3) = pose.rotation_jacobian.middleCols<3>(3 * k);
  }
  return saccade::covariance_at(covariances, basis.first, by_controls);
}

RefinedPath refine_path(const MapSurface& surface, const PinholeCamera& camera,
                        const EventContrast& contrast, std::span<const Event> events,
                        std::span<const StampedPose> start, const PoseRefinementOptions& options) {
  RefinedPath path;
  path.map_from_camera = SplineControls::smooth(start, options.knot_spacing_s);
  if (options.residual == PoseRefinementOptions::Residual::kFrames) {
    const auto images =
        observe_increments(events, camera, contrast, options.window_events, options.increments);
    const double mean_contrast = std::hypot(contrast.on, contrast.off) / std::sqrt(2.0);
    IncrementResiduals residuals(surface, images, mean_contrast, options);
    refine_by(residuals, options, path);
  } else {
    const EventRunObservations observed =
        observe_log_intensity(events, camera, contrast, options.events, options.run_events);
    EventRunResiduals residuals(surface, observed, options);
    refine_by(residuals, options, path);
  }
  return path;
}

}  // namespace saccade
