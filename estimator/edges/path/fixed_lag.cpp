#include "estimator/edges/path/fixed_lag.h"

#include <algorithm>
#include <utility>

#include "estimator/edges/least_squares/cost_log.h"

namespace saccade {
namespace {

double first_event_s(const EdgeView& view) {
  double first_s = view.t_s;
  for (const EdgeEvent& event : view.events) first_s = std::min(first_s, event.t_s);
  return first_s;
}

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
                   {options_.events_per_edge, options_.events_per_edge, held_until_s});
}

void FixedLagSmoother::add(EdgeView newest) {
  if (newest.edges.empty()) return;
  std::erase_if(views_,
                [&](const EdgeView& view) { return view.t_s < newest.t_s - options_.lag_s; });
  views_.push_back(std::move(newest));
}

std::optional<Trajectory> FixedLagSmoother::smooth(const Trajectory& path, double held_until_s,
                                                   double typical_depth_m) const {
  if (views_.size() < 2) return std::nullopt;
  PathInput input;
  input.path = part_from(path, first_event_s(views_.front()));
  input.typical_depth_m = typical_depth_m;
  const double from_s = input.path.front().t_s;
  if (from_s > path.start_s()) held_until_s = std::max(held_until_s, from_s + options_.held_s);
  const auto is_held = [&](const StampedPose& pose) { return pose.t_s <= held_until_s; };
  std::copy_if(input.path.begin(), input.path.end(), std::back_inserter(input.given), is_held);
  const Trajectory before = smoothed_path(input.path, options_.smoothing_s);
  PathEdgeProblem problem(before, views_, input, camera_.undistorted(), options_.problem);
  CostLog costs;
  if (!problem.solve(costs)) return std::nullopt;
  const Trajectory after = problem.path();
  for (StampedPose& pose : input.path)
    if (!is_held(pose)) pose.world_from_camera = after.at_clamped(pose.t_s);
  return Trajectory(std::move(input.path));
}

}  // namespace saccade
