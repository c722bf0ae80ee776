#include "estimator/odometry/start/path_refinement.h"

#include <utility>
#include <vector>

#include "estimator/edges/least_squares/robust_spread.h"

namespace saccade {
namespace {

double median_depth(const WindowEdgels& edges) {
  std::vector<float> inverse;
  inverse.reserve(edges.edges.size());
  for (const FittedEdgel& edge : edges.edges) inverse.push_back(edge.edge.inverse_depth);
  return 1 / static_cast<double>(median_of(inverse));
}

Trajectory scaled(const Trajectory& path, double scale) {
  std::vector<StampedPose> poses(path.poses().begin(), path.poses().end());
  for (StampedPose& pose : poses)
    pose.world_from_camera = {pose.world_from_camera.rotation(),
                              scale * pose.world_from_camera.translation()};
  return Trajectory(std::move(poses));
}

/// Of a free path, whose typical depth is 1: with edges near it whose events hardly tell their depth.
RayDepthOptions of_assumed_depth(const RayDepthOptions& rays) {
  constexpr double kFactor = 9;  // as of the first map (Mapper)
  RayDepthOptions assuming = rays.with_larger_sigmas(kFactor);
  assuming.assumed_inverse_depth = 1;
  return assuming;
}

}  // namespace

PathRefinementOptions start_refinement() {
  PathRefinementOptions options;
  // Sharper than those of known poses: the edges say what the poses are.
  options.rays.refiner.max_sigma = 0.015;
  options.adjustment.prior_of = WindowAdjustmentOptions::PriorOf::kPose;
  options.adjustment.pose_sigma_px = 20;
  options.adjustment.smoothness_sigma_px = 0.3;
  options.adjustment.fixed_sigma_px = 0.05;
  options.adjustment.surface_sigma = 0.02;
  options.adjustment.iterations = 20;
  return options;
}

PathRefinementOptions measuring_rotation(PathRefinementOptions options,
                                         const Gyroscope& gyroscope) {
  /// Sigma of rotations over that of translations, as image motion.
  constexpr double kRotationSigmaRatio = 0.05;
  if (gyroscope.is_empty()) return options;
  options.adjustment.rotation_sigma_ratio = kRotationSigmaRatio;
  options.adjustment.has_parallax_prior = false;
  return options;
}

PathRefinement::PathRefinement(const PathRefinementOptions& options, const PinholeCamera& camera)
    : options_(options),
      camera_(camera),
      depth_(options.rays, options.limits, camera),
      assuming_(of_assumed_depth(options.rays), options.limits, camera) {}

FreePath PathRefinement::refine(std::span<const Event> events, const Trajectory& path, int rounds,
                                double given_until_s) const {
  const bool is_free = given_until_s == kNoGivenPoses;
  FreePath result;
  result.poses = path;
  const double reference_s =
      (seconds_from_ns(events.front().t_ns) + seconds_from_ns(events.back().t_ns)) / 2;
  for (int i = 0; i < rounds; ++i) {
    const ViewWindow window{events, &result.poses, reference_s};
    WindowEdgels edges = depth_.find_edgels(window);
    if (is_free && edges.edges.size() < options_.enough_edges)
      edges = assuming_.find_edgels(window);
    result.edges = edges.edges.size();
    result.events = 0;
    for (const FittedEdgel& edge : edges.edges) result.events += edge.last - edge.first;
    if (edges.edges.size() < options_.min_edges) return result;
    const WindowAdjustment adjustment =
        adjust_window(window, edges, camera_,
                      {given_until_s, given_until_s, median_depth(edges), {}}, options_.adjustment);
    if (!adjustment.ok || adjustment.edges.edges.empty()) return result;
    result.residual_px = adjustment.residual_after_px;
    result.poses = is_free ? scaled(adjustment.trajectory, 1 / median_depth(adjustment.edges))
                           : adjustment.trajectory;
  }
  result.is_clear = true;
  return result;
}

}  // namespace saccade
