#include "estimator/odometry/start/first_map.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "estimator/odometry/start/extrapolated_path.h"
#include "estimator/odometry/view_turn.h"
#include "estimator/run/view_windows.h"

namespace saccade {
namespace {

/// `path` with the given poses as they are, and what follows after the last of them.
Trajectory with_given_poses(const Trajectory& path, const PathEstimate& start) {
  const double until_s = start.given_until_s;
  const Rigid3 given_from_found =
      start.poses.at_clamped(until_s) * path.at_clamped(until_s).inverse();
  std::vector<StampedPose> poses(path.poses().begin(), path.poses().end());
  for (StampedPose& pose : poses)
    pose.world_from_camera = pose.t_s <= until_s ? start.poses.at_clamped(pose.t_s)
                                                 : given_from_found * pose.world_from_camera;
  return Trajectory(std::move(poses));
}

/// Extrapolated poses turn the view by this part of its angle at most: a fast turn does not keep its
/// velocity, and what is seen meanwhile leaves the view.
constexpr double kMostTurn = 0.25;

double longest_path_s(std::span<const Event> events, const PathEstimate& start,
                      const PinholeCamera& camera, const FirstMapOptions& options,
                      const Gyroscope& gyroscope) {
  const double start_s = start.poses.start_s(), end_s = start.poses.end_s();
  const double longest_s =
      std::min(options.window_s, seconds_from_ns(events.back().t_ns) - start_s);
  const Trajectory path =
      extrapolated(start.poses, start_s + longest_s, gyroscope, last_acceleration(start.poses));
  const Rigid3 given = start.poses.poses().back().world_from_camera;
  for (const StampedPose& pose : path.poses())
    if (pose.t_s > end_s &&
        view_turn(given, pose.world_from_camera) > kMostTurn * angle_of_view(camera))
      return std::min(longest_s, pose.t_s - start_s);
  return longest_s;
}

constexpr double kPathGrowth = 1.15;  ///< of the path, from round to round

/// How much more the given poses' rotation moves the image than their translation, at this depth:
/// by all of their way and by what their acceleration adds to it in as much time again.
double rotation_ratio(const Trajectory& given, double depth_m) {
  constexpr double kLeast = 0.05;  // or its inverse: nothing moves in one way alone for long
  const double length_s = given.end_s() - given.start_s();
  const Twist way =
      (given.poses().front().world_from_camera.inverse() * given.poses().back().world_from_camera)
          .log();
  const Twist more = 0.5 * length_s * length_s * last_acceleration(given).rate;
  const double translation = (way.head<3>().norm() + more.head<3>().norm()) / depth_m;
  const double rotation = way.tail<3>().norm() + more.tail<3>().norm();
  if (!(rotation > 0 || translation > 0)) return 1;
  return std::clamp(rotation / std::max(translation, kLeast * rotation), kLeast, 1 / kLeast);
}

/// Edges hardly distinguish a rotation from the translation that moves the image alike. What they
/// leave open is shared out by the sigmas of both: in equal parts, a camera on a slider would turn
/// by half of what it is faster than extrapolated. As the given poses moved, so it goes on.
PathRefinementOptions following(const Trajectory& given, double depth_m,
                                PathRefinementOptions options) {
  // Of the path from round to round, which is extrapolated anew each time by what was found.
  constexpr double kSmoothness_px = 0.1;
  options.adjustment.smoothness_sigma_px = kSmoothness_px;
  options.adjustment.rotation_sigma_ratio = rotation_ratio(given, depth_m);
  return options;
}

/// Where the motion is a rotation, or nearly none, no depth is found, and the one that is assumed
/// matters little. The path is extrapolated only for as long as its events show too few edges.
FirstMap map_of_assumed_depth(std::span<const Event> events, const PathEstimate& start,
                              const Mapper& mapper, const PinholeCamera& camera,
                              const FirstMapOptions& options, const Gyroscope& gyroscope) {
  FirstMap first{start, {}};
  const double start_s = start.poses.start_s();
  const double longest_s = longest_path_s(events, start, camera, options, gyroscope);
  // In the middle of what may be, as ratios count.
  const DepthLimits& limits = options.refinement.limits;
  first.path.typical_depth_m = std::sqrt(limits.near_m * limits.far_m);
  double length_s = start.poses.end_s() - start_s;
  while (true) {
    first.mapping = mapper.map(within(events, first.path.poses), first.path);
    if (first.mapping.keyframe.edges.size() >= Mapper::kMinEdges || length_s >= longest_s)
      return first;
    length_s = std::min(kPathGrowth * length_s, longest_s);
    first.path.poses =
        extrapolated(start.poses, start_s + length_s, gyroscope, last_acceleration(start.poses));
  }
}

/// The depth at which edges are assumed whose depth the given poses do not tell: `otherwise_m`, if
/// the edges do not say together that it is wrong by more than is assumed anyway.
double assumed_depth_m(std::span<const Event> events, const PathEstimate& start,
                       const Mapper& mapper, double near_m, double otherwise_m) {
  // From near on: the window over which edges are matched is short there, so that they are matched
  // right. A step goes a third to all of the way.
  constexpr int kMostSteps = 6;
  constexpr double kNearer = 4, kSettled = 0.02;
  const double first_m = std::max(near_m, otherwise_m / kNearer);
  double depth_m = first_m;
  for (int i = 0; i < kMostSteps; ++i) {
    const std::optional<double> next_m = mapper.common_depth(events, start, depth_m);
    if (!next_m) return otherwise_m;
    const double before_m = std::exchange(depth_m, *next_m);
    if (std::abs(depth_m - before_m) < kSettled * before_m) break;
  }
  // Edges that know nothing leave any assumption as it is.
  constexpr double kMoved = 0.1;
  if (std::abs(depth_m - first_m) < kMoved * first_m) {
    const std::optional<double> next_m = mapper.common_depth(events, start, otherwise_m);
    if (!next_m || *next_m > (1 - kMoved) * otherwise_m) return otherwise_m;
  }
  const double relative = otherwise_m / depth_m;  // of the inverse depths
  return std::abs(relative - 1) < RayDepthOptions::kAssumedSigma ? otherwise_m : depth_m;
}

}  // namespace

FirstMap first_map(std::span<const Event> events, const PathEstimate& start, const Mapper& mapper,
                   const PinholeCamera& camera, const FirstMapOptions& options,
                   const Gyroscope& gyroscope) {
  FirstMap first{start, mapper.map(within(events, start.poses), start)};
  const auto is_enough = [&] { return first.mapping.keyframe.edges.size() >= options.min_edges; };
  if (is_enough() || start.given_until_s == kNoGivenPoses || events.empty()) return first;
  const DepthLimits& limits = options.refinement.limits;
  // In the middle of what may be, as ratios count.
  const double otherwise_m = first.mapping.keyframe.edges.size() >= Mapper::kMinEdges
                                 ? first.mapping.keyframe.typical_depth_m
                                 : std::sqrt(limits.near_m * limits.far_m);
  FirstMap assumed{start, {}};
  assumed.path.typical_depth_m =
      assumed_depth_m(within(events, start.poses), start, mapper, limits.near_m, otherwise_m);
  assumed.mapping = mapper.map(within(events, start.poses), assumed.path);
  if (assumed.mapping.keyframe.edges.size() >= options.min_edges) return assumed;
  const PathRefinement refinement(
      measuring_rotation(following(start.poses, *assumed.path.typical_depth_m, options.refinement),
                         gyroscope),
      camera);
  const double start_s = start.poses.start_s();
  const double longest_s = longest_path_s(events, start, camera, options, gyroscope);
  const PathAcceleration acceleration = last_acceleration(start.poses);
  PathEstimate path = start;
  double length_s = path.poses.end_s() - start_s;
  while (!is_enough() && length_s < longest_s) {
    length_s = std::min(kPathGrowth * length_s, longest_s);
    const Trajectory longer = extrapolated(path.poses, start_s + length_s, gyroscope, acceleration);
    const std::span<const Event> window = within(events, longer);
    if (window.empty()) continue;
    // Where there is too little to adjust it by, the path is the longer one as it is.
    path.poses =
        with_given_poses(refinement.refine(window, longer, 1, start.given_until_s).poses, start);
    Mapping mapping = mapper.map(window, path);
    if (mapping.keyframe.edges.size() > first.mapping.keyframe.edges.size())
      first = {path, std::move(mapping)};
  }
  if (first.mapping.keyframe.edges.size() < Mapper::kMinEdges)
    return map_of_assumed_depth(events, start, mapper, camera, options, gyroscope);
  // Now the typical depth is known, at which edges of an unknown one are tracked.
  first.path.typical_depth_m = first.mapping.keyframe.typical_depth_m;
  Mapping mapping = mapper.map(within(events, first.path.poses), first.path);
  if (mapping.keyframe.edges.size() > first.mapping.keyframe.edges.size())
    first.mapping = std::move(mapping);
  return first;
}

}  // namespace saccade
