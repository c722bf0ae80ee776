#include "estimator/edges/path/fixed_lag.h"

#include <algorithm>
#include <utility>

#include "estimator/edges/least_squares/cost_log.h"

namespace saccade {
namespace {

/// The part of a path from the last pose until `from_s` on.
std::vector<StampedPose> part_from(const Trajectory& path, double from_s) {
  const std::size_t first = path.last_before(from_s).value_or(0);
  const std::span<const StampedPose> part = path.poses().subspan(first);
  return {part.begin(), part.end()};
}

}  // namespace

EdgeView FixedLagSmoother::view(const ViewWindow& window, const WindowEdgels& found,
                                double held_until_s) const {
  return edge_view(window, found, camera_,
                   {options_.events_per_edge, options_.given_events_per_edge, held_until_s});
}

void FixedLagSmoother::add(EdgeView newest, double held_until_s) {
  if (newest.edges.empty()) return;
  std::vector<EdgeView> kept;
  std::size_t adjusted = 0;
  for (std::size_t i = 0; i < views_.size(); ++i) {
    // What a longer window with the same events shows was found on a better path.
    const bool is_repeated = views_[i].from_s >= newest.from_s && views_[i].until_s > held_until_s;
    if (views_[i].t_s < newest.t_s - options_.lag_s || is_repeated) continue;
    if (i < adjusted_views_) ++adjusted;
    kept.push_back(std::move(views_[i]));
  }
  kept.push_back(std::move(newest));
  views_ = std::move(kept);
  adjusted_views_ = adjusted;
}

std::optional<Trajectory> FixedLagSmoother::smooth(const Trajectory& path, double held_until_s,
                                                   double typical_depth_m,
                                                   std::span<const Landmark> landmarks) {
  if (views_.empty()) return std::nullopt;
  const PinholeCamera camera = camera_.undistorted();
  const auto information_of_px = [&](double px) -> Matrix6 {
    return sigma_of_px(px, camera, typical_depth_m).cwiseAbs2().cwiseInverse().asDiagonal();
  };
  PathInput input;
  input.path = part_from(path, views_.front().from_s);
  input.typical_depth_m = typical_depth_m;
  input.landmarks = landmarks;
  const double from_s = input.path.front().t_s;
  const Trajectory before = smoothed_path(input.path, options_.smoothing_s);
  const SplineKnots knots = known_.knots(from_s, before.end_s());
  if (known_.empty()) {
    if (from_s > path.start_s()) held_until_s = std::max(held_until_s, from_s + options_.held_s);
    for (const StampedPose& pose : input.path)
      if (pose.t_s <= held_until_s) {
        const Rigid3 now = before.at_clamped(pose.t_s);
        known_.add_pose(knots, pose.t_s, (now.inverse() * pose.world_from_camera).log(),
                        information_of_px(options_.problem.given_sigma_px));
      }
  } else {
    known_.move(path_, before);
    known_.begin_with(knots, information_of_px(options_.problem.correction_sigma_px));
  }
  PathEdgeProblem problem(before, views_, input, {knots, adjusted_views_}, camera,
                          options_.problem);
  if (!known_.empty()) problem.add_prior(known_.cost(), known_.controls());
  CostLog costs;
  if (!problem.solve(costs)) {
    clear();
    return std::nullopt;
  }
  path_ = problem.path();
  take_over(problem);
  for (StampedPose& pose : input.path)
    if (pose.t_s > held_until_s) pose.world_from_camera = path_.at_clamped(pose.t_s);
  return Trajectory(std::move(input.path));
}

void FixedLagSmoother::take_over(PathEdgeProblem& problem) {
  const SplineKnots& knots = problem.correction().knots();
  const std::span<const double> controls = problem.bundle().path();
  known_.correct(knots, Eigen::Map<const Eigen::VectorXd>(
                            controls.data(), static_cast<Eigen::Index>(controls.size())));
  const double fresh_from_s = views_.back().t_s - options_.fresh_s;
  std::size_t last = adjusted_views_;
  while (last < views_.size() && views_[last].t_s < fresh_from_s) ++last;
  if (last == adjusted_views_) return;
  if (const auto information = problem.information_of_views(adjusted_views_, last))
    known_.add(knots, *information);
  adjusted_views_ = last;
}

}  // namespace saccade
