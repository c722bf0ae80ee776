#include "estimator/odometry/start/path_refinement.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace saccade {
namespace {

double median_depth(const WindowEdgels& edges) {
  std::vector<float> inverse;
  inverse.reserve(edges.edges.size());
  for (const FittedEdgel& edge : edges.edges) inverse.push_back(edge.edge.inverse_depth);
  const auto middle = inverse.begin() + static_cast<std::ptrdiff_t>(inverse.size() / 2);
  std::nth_element(inverse.begin(), middle, inverse.end());
  return 1 / static_cast<double>(*middle);
}

Trajectory scaled(const Trajectory& path, double scale) {
  std::vector<StampedPose> poses(path.poses().begin(), path.poses().end());
  for (StampedPose& pose : poses)
    pose.world_from_camera = {pose.world_from_camera.rotation(),
                              scale * pose.world_from_camera.translation()};
  return Trajectory(std::move(poses));
}

}  // namespace

PathRefinementOptions start_refinement() {
  PathRefinementOptions options;
  options.adjustment.edges = 800;
  options.adjustment.node_spacing_s = 0.02;
  options.adjustment.prior_of = WindowAdjustmentOptions::PriorOf::kPose;
  options.adjustment.pose_sigma_px = 20;
  options.adjustment.smoothness_sigma_px = 0.3;
  options.adjustment.surface_sigma = 0.02;
  options.adjustment.iterations = 20;
  return options;
}

PathRefinement::PathRefinement(const PathRefinementOptions& options, const PinholeCamera& camera)
    : options_(options), camera_(camera), depth_(options.rays, options.limits, camera) {}

FreePath PathRefinement::refine(std::span<const Event> events, const Trajectory& path, int rounds,
                                double given_until_s) const {
  const bool is_free = given_until_s == kNoGivenPoses;
  FreePath result;
  result.poses = path;
  const double reference_s =
      (seconds_from_ns(events.front().t_ns) + seconds_from_ns(events.back().t_ns)) / 2;
  for (int i = 0; i < rounds; ++i) {
    const ViewWindow window{events, &result.poses, reference_s};
    const WindowEdgels edges = depth_.find_edgels(window);
    result.edges = edges.edges.size();
    result.events = 0;
    for (const FittedEdgel& edge : edges.edges) result.events += edge.last - edge.first;
    if (edges.edges.size() < options_.min_edges) return result;
    const WindowAdjustment adjustment =
        adjust_window(window, edges, camera_,
                      {given_until_s, given_until_s, median_depth(edges), {}}, options_.adjustment);
    if (!adjustment.ok) return result;
    result.residual_px = adjustment.residual_after_px;
    result.poses = is_free ? scaled(adjustment.trajectory, 1 / median_depth(adjustment.edges))
                           : adjustment.trajectory;
  }
  result.is_clear = true;
  return result;
}

}  // namespace saccade
