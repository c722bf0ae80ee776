#include "estimator/odometry/mapper.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/random.h"
#include "core/spline/spline.h"
#include "core/time_search.h"
#include "estimator/depth/sweep/sweep_depth.h"
#include "estimator/edges/least_squares/robust_spread.h"
#include "estimator/odometry/certain_points.h"
#include "estimator/odometry/view_turn.h"
#include "estimator/reconstruction/surface/point_surface.h"

namespace saccade {
namespace {

/// Median of the depths [m]; `otherwise` for none.
double median_depth(const DepthResult& result, double otherwise) {
  if (result.points.empty()) return otherwise;
  std::vector<float> inverse;
  inverse.reserve(result.points.size());
  for (const EdgePoint& point : result.points) inverse.push_back(point.inverse_depth);
  return 1 / static_cast<double>(median_of(inverse));
}

/// The points in the camera of their view.
std::vector<SurfacePoint> surface_points(const DepthResult& result, const PinholeCamera& camera) {
  std::vector<SurfacePoint> points;
  points.reserve(result.points.size());
  for (const EdgePoint& point : result.points) {
    const double depth = 1 / static_cast<double>(point.inverse_depth);
    points.push_back({depth * camera.ray({point.x_px, point.y_px}),
                      static_cast<double>(point.sigma / point.inverse_depth)});
  }
  return points;
}

/// A component of the reconstructed gradient where it is known, else 0.
ImageF observed(ImageF component, const ImageU8& observed) {
  for (std::size_t i = 0; i < component.size(); ++i)
    if (observed.pixels()[i] == 0) component.pixels()[i] = 0;
  return component;
}

/// The events that the keyframe was made from.
ViewWindow window_of(std::span<const Event> events, const Trajectory& poses,
                     const Keyframe& keyframe) {
  ViewWindow window{within(events, poses), &poses, keyframe.t_s};
  window.events = window.events.subspan(count_before(
      window.events, keyframe.start_s, [](const Event& e) { return seconds_from_ns(e.t_ns); }));
  window.events = window.events.first(std::min(window.events.size(), keyframe.events));
  return window;
}

/// The events of a random part of the pixels, so that about `most` are left. All events of a pixel or
/// none: the position of an event in its run follows from those before it.
std::vector<Event> of_some_pixels(std::span<const Event> events, std::size_t most,
                                  const PinholeCamera& camera) {
  const Random random(0);
  const double fraction = static_cast<double>(most) / static_cast<double>(events.size());
  ImageU8 is_kept(camera.width, camera.height);
  for (std::size_t i = 0; i < is_kept.size(); ++i)
    is_kept.pixels()[i] = random.uniform(i, 0) < fraction ? 1 : 0;
  std::vector<Event> kept;
  kept.reserve(most + most / 8);
  for (const Event& event : events)
    if (is_kept(event.x, event.y) != 0) kept.push_back(event);
  return kept;
}

/// A window that is shorter than usual is adjusted by more edges and more often, for about the same time: at
/// the start depths and poses are poor.
WindowAdjustmentOptions for_length(WindowAdjustmentOptions adjustment, double length_s,
                                   double usual_s) {
  constexpr double kMostEdges = 4, kMostIterations = 2;  ///< times as many
  const double shorter = std::max(1.0, usual_s / std::max(length_s, 1e-3));
  adjustment.edges = static_cast<int>(adjustment.edges * std::min(shorter, kMostEdges));
  adjustment.iterations =
      static_cast<int>(adjustment.iterations * std::min(shorter, kMostIterations));
  return adjustment;
}

/// Edges of nine times the sigma count, too, in parts of the view that have few others.
MappingOptions relaxed(MappingOptions options) {
  constexpr double kFactor = 9;
  options.certain_sigma = options.max_sigma;
  options.max_sigma *= kFactor;
  options.depth.rays = options.depth.rays.with_larger_sigmas(kFactor);
  return options;
}

}  // namespace

Mapper::Mapper(const MappingOptions& options, const PinholeCamera& camera)
    : options_(options), camera_(camera) {
  // Where there are few edges less certain ones are taken by the rules of the map (min_edges).
  options_.depth.rays.least_points = 0;
  // Its poses are of the same events, also where a depth is estimated of a window.
  options_.depth.rays.find_delay = false;
}

Mapping Mapper::map(std::span<const Event> events, const PathEstimate& path) const {
  if (options_.min_edges == 0) return map_once(events, path);
  MappingOptions options = relaxed(options_);
  Mapping mapping = Mapper(options, camera_).map_once(events, path);
  const bool is_enough =
      mapping.keyframe.edges.size() >= static_cast<std::size_t>(options_.min_edges);
  if (is_enough || !path.typical_depth_m) return mapping;
  options.depth.rays.assumed_inverse_depth = 1 / *path.typical_depth_m;
  Mapping assuming = Mapper(options, camera_).map_once(events, path);
  return assuming.keyframe.edges.size() > mapping.keyframe.edges.size() ? std::move(assuming)
                                                                        : std::move(mapping);
}

Mapping Mapper::map_once(std::span<const Event> events, const PathEstimate& path) const {
  Mapping mapping;
  Keyframe& keyframe = mapping.keyframe;
  ViewWindow window;
  window.events = newest(within(events, path.poses), path.poses);
  if (window.events.empty()) return mapping;
  const Trajectory smooth = smoothed(path.poses, window.events);
  Trajectory adjusted = smooth;
  window.trajectory = &adjusted;
  keyframe.start_s = seconds_from_ns(window.events.front().t_ns);
  keyframe.end_s = seconds_from_ns(window.events.back().t_ns);
  keyframe.events = window.events.size();
  const auto most = static_cast<std::size_t>(options_.depth_events);
  std::vector<Event> some;
  if (options_.edges == MappingOptions::Edges::kDepth && window.events.size() > most)
    window.events = some = of_some_pixels(window.events, most, camera_);
  if (window.events.empty()) return mapping;
  window.reference_s = options_.view == MappingOptions::View::kEnd
                           ? keyframe.end_s
                           : (keyframe.start_s + keyframe.end_s) / 2;
  const double expected_m = path.typical_depth_m ? *path.typical_depth_m : sweep_depth(window);
  std::optional<WindowEdgels> edges = adjust_path(window, adjusted, path, expected_m);
  // Without an adjustment the edges are found for their own sake.
  if (!edges && options_.depth.rays.assumed_inverse_depth) edges = rays().find_edgels(window);
  mapping.world_from_before =
      adjusted.at_clamped(keyframe.end_s) * smooth.at_clamped(keyframe.end_s).inverse();
  for (const StampedPose& pose : adjusted.poses())
    if (pose.t_s >= keyframe.start_s) mapping.poses.push_back(pose);
  keyframe.t_s = window.reference_s;
  keyframe.world_from_camera = window.world_from_reference();
  keyframe.depth =
      certain(edges ? rays().fuse(*edges)
                    : make_depth_estimator(options_.depth, camera_, expected_m)->estimate(window));
  keyframe.typical_depth_m = median_depth(keyframe.depth, expected_m);
  if (options_.edges == MappingOptions::Edges::kGradient) {
    if (keyframe.depth.points.empty()) return mapping;
    const ImageF depth = dense_depth(keyframe);
    reconstruct(window, depth, keyframe);
    add_steep_pixels(depth, keyframe);
  } else {
    add_points(keyframe);
    if (edges) add_assumed_points(*edges, keyframe);
  }
  if (edges)
    mapping.edges = {{window.events.begin(), window.events.end()}, std::move(*edges), options_};
  return mapping;
}

std::optional<double> Mapper::common_depth(std::span<const Event> events, const PathEstimate& path,
                                           double assumed_m) const {
  // Few edges next to the camera would say more than all others.
  constexpr double kMostInformation = 2;  // of that of the assumption
  constexpr double kLeastInformation = 1 / (0.1 * 0.1);
  // The regression weighs the assumption by the noise of the iteration before: what is left of it
  // after it is taken out, by thousands of edges that know nothing, would look like knowledge.
  constexpr double kRemainder = 0.1;
  constexpr double kAssumption =
      1 / (RayDepthOptions::kAssumedSigma * RayDepthOptions::kAssumedSigma);
  ViewWindow window;
  window.events = newest(within(events, path.poses), path.poses);
  if (window.events.empty()) return std::nullopt;
  const Trajectory smooth = smoothed(path.poses, window.events);
  window.trajectory = &smooth;
  window.reference_s =
      (seconds_from_ns(window.events.front().t_ns) + seconds_from_ns(window.events.back().t_ns)) /
      2;
  std::vector<Event> some;
  if (const auto most = static_cast<std::size_t>(options_.depth_events);
      window.events.size() > most)
    window.events = some = of_some_pixels(window.events, most, camera_);
  if (window.events.empty()) return std::nullopt;
  MappingOptions assuming = relaxed(options_);
  assuming.depth.rays.assumed_inverse_depth = 1 / assumed_m;
  const WindowEdgels found = Mapper(assuming, camera_).rays().find_edgels(window);
  std::vector<WeightedValue> inverse;  // relative to the assumed one
  double information = 0;
  for (std::size_t i = 0; i < found.edges.size(); ++i) {
    // What the events say, without the assumption where that was added to it.
    const FittedEdgel& fitted = found.edges[i];
    const double assumption = i < found.first_assumed ? 0 : kAssumption;
    const double sigma = static_cast<double>(fitted.sigma) * assumed_m;
    const double all = 1 / (sigma * sigma);
    const double own = all - assumption;
    if (!(own > kRemainder * assumption) || !std::isfinite(own)) continue;
    const double value = static_cast<double>(fitted.edge.inverse_depth) * assumed_m;
    inverse.push_back(
        {(value * all - assumption) / own, std::min(own, kMostInformation * kAssumption)});
    information += inverse.back().weight;
  }
  if (information < kLeastInformation) return std::nullopt;
  const DepthLimits& limits = options_.depth.limits;
  const double nearest = assumed_m / limits.near_m, furthest = assumed_m / limits.far_m;
  return assumed_m / std::clamp(weighted_median(inverse), furthest, nearest);
}

void Mapper::refit(const Trajectory& path, const PathEstimate& estimate, Mapping& mapping) const {
  KeyframeEdges& found = *mapping.edges;
  Keyframe& keyframe = mapping.keyframe;
  const ViewWindow window{found.events, &path, keyframe.t_s};
  found.edges = edges_on_path(window, found.edges, camera_,
                              {estimate.fixed_until_s, estimate.given_until_s,
                               keyframe.typical_depth_m, estimate.landmarks},
                              options_.adjustment);
  keyframe.world_from_camera = window.world_from_reference();
  const Mapper mapper(found.options, camera_);
  keyframe.depth = mapper.certain(mapper.rays().fuse(found.edges));
  mapper.add_points(keyframe);
  mapper.add_assumed_points(found.edges, keyframe);
}

void Mapper::renew(std::span<const Event> events, const Trajectory& poses,
                   Keyframe& keyframe) const {
  keyframe.world_from_camera = poses.at_clamped(keyframe.t_s);
  keyframe.depth = rays().estimate(window_of(events, poses, keyframe));
  keyframe.typical_depth_m = median_depth(keyframe.depth, keyframe.typical_depth_m);
  add_points(keyframe);
}

void Mapper::add_image(std::span<const Event> events, const Trajectory& poses,
                       Keyframe& keyframe) const {
  if (!keyframe.image.log_image.empty() || keyframe.depth.points.empty()) return;
  const PinholeCamera camera = camera_.undistorted();
  const ImageF depth = coarse_surface_through(surface_points(keyframe.depth, camera), camera);
  reconstruct(window_of(events, poses, keyframe), depth, keyframe);
}

DepthResult Mapper::certain(DepthResult depth) const {
  if (options_.certain_sigma > 0) keep_certain(camera_, options_.certain_sigma, depth.points);
  return depth;
}

RayDepth Mapper::rays() const {
  return RayDepth(options_.depth.rays, options_.depth.limits, camera_);
}

std::optional<WindowEdgels> Mapper::adjust_path(ViewWindow& window, Trajectory& path,
                                                const PathEstimate& estimate,
                                                double typical_depth_m) const {
  std::optional<WindowEdgels> edges;
  const RayDepth depth = rays();
  const double length_s = seconds_from_ns(window.events.back().t_ns - window.events.front().t_ns);
  const WindowAdjustmentOptions adjustment_options =
      for_length(options_.adjustment, length_s, options_.duration_s);
  for (int i = 0; i < options_.adjust_rounds; ++i) {
    edges = depth.find_edgels(window);
    WindowAdjustment adjustment = adjust_window(
        window, *edges, camera_,
        {estimate.fixed_until_s, estimate.given_until_s, typical_depth_m, estimate.landmarks},
        adjustment_options);
    if (!adjustment.ok) break;
    path = std::move(adjustment.trajectory);
    edges = std::move(adjustment.edges);
  }
  return edges;
}

std::span<const Event> Mapper::newest(std::span<const Event> events, const Trajectory& path) const {
  events = events.last(std::min(events.size(), static_cast<std::size_t>(options_.events)));
  if (events.empty()) return events;
  events = events.subspan(
      count_before(events, events.back().t_ns - ns_from_seconds(options_.duration_s)));
  if (options_.turn <= 0) return events;
  const double most = options_.turn * angle_of_view(camera_);
  const Rigid3 last = path.at_clamped(seconds_from_ns(events.back().t_ns));
  const std::span<const StampedPose> poses = path.poses();
  const auto before = path.last_before(seconds_from_ns(events.back().t_ns));
  for (std::size_t i = before ? *before + 1 : 0; i-- > 0;)
    if (view_turn(poses[i].world_from_camera, last) > most)
      return events.subspan(count_before(events, ns_from_seconds(poses[i].t_s)));
  return events;
}

Trajectory Mapper::smoothed(const Trajectory& poses, std::span<const Event> events) const {
  // Poses beside the window constrain the spline's ends.
  constexpr double kMargin_s = 0.05;
  const double from_s = seconds_from_ns(events.front().t_ns) - kMargin_s;
  // With the pose before, so that the part spans all of the events.
  const std::size_t first = poses.last_before(from_s).value_or(0);
  const std::span<const StampedPose> newest = poses.poses().subspan(first);
  std::vector<StampedPose> part(newest.begin(), newest.end());
  if (options_.smoothing_s <= 0 || part.back().t_s - part.front().t_s < 4 * options_.smoothing_s)
    return Trajectory(std::move(part));
  const Spline spline = Spline::smooth(part, options_.smoothing_s);
  for (StampedPose& pose : part) pose.world_from_camera = spline.pose(pose.t_s);
  return Trajectory(std::move(part));
}

double Mapper::sweep_depth(const ViewWindow& window) const {
  const DepthLimits& limits = options_.depth.limits;
  const SweepDepth sweep(limits, camera_);
  return median_depth(sweep.estimate(window), std::sqrt(limits.near_m * limits.far_m));
}

ImageF Mapper::dense_depth(const Keyframe& keyframe) const {
  const PinholeCamera camera = camera_.undistorted();
  return surface_through(surface_points(keyframe.depth, camera), camera);
}

void Mapper::reconstruct(const ViewWindow& window, const ImageF& depth, Keyframe& keyframe) const {
  const ReconstructionWindow input{
      window,
      scene_of(depth, camera_.undistorted(), keyframe.world_from_camera,
               options_.reconstruction.depth),
      *options_.reconstruction.contrast_on, *options_.reconstruction.contrast_off};
  keyframe.image = make_image_estimator(options_.reconstruction, camera_)->reconstruct(input);
}

void Mapper::add_steep_pixels(const ImageF& depth, Keyframe& keyframe) const {
  const Reconstruction& image = keyframe.image;
  const MapPoints steep = lift_edges(observed(image.gradient_x, image.observed),
                                     observed(image.gradient_y, image.observed), depth,
                                     camera_.undistorted(), options_.steep);
  for (std::size_t i = 0; i < steep.size(); ++i) {
    const Eigen::Vector3d point =
        keyframe.world_from_camera * Eigen::Vector3d(steep.x[i], steep.y[i], steep.z[i]);
    keyframe.edges.x.push_back(static_cast<float>(point.x()));
    keyframe.edges.y.push_back(static_cast<float>(point.y()));
    keyframe.edges.z.push_back(static_cast<float>(point.z()));
  }
}

void Mapper::add_points(Keyframe& keyframe) const {
  keyframe.edges = points_in_world(keyframe.depth, camera_.undistorted(),
                                   keyframe.world_from_camera, options_.max_sigma);
}

void Mapper::add_assumed_points(const WindowEdgels& edges, Keyframe& keyframe) const {
  const RayDepthOptions& rays = options_.depth.rays;
  if (!rays.assumed_inverse_depth) return;
  const PinholeCamera camera = camera_.undistorted();
  // What the fit made of the depth is noise: it stays as it was assumed.
  const double depth_m = 1 / *rays.assumed_inverse_depth;
  for (const FittedEdgel& fitted : edges.edges) {
    if (!rays.is_assumed(fitted)) continue;
    const Eigen::Vector3f point =
        (keyframe.world_from_camera * (depth_m * camera.ray(fitted.edge.pixel.cast<double>())))
            .cast<float>();
    keyframe.edges.x.push_back(point.x());
    keyframe.edges.y.push_back(point.y());
    keyframe.edges.z.push_back(point.z());
  }
}

}  // namespace saccade
