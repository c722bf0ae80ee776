#include "estimator/odometry/start/bootstrap.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "core/time_search.h"
#include "estimator/odometry/start/extrapolated_path.h"
#include "estimator/odometry/start/flow_motion.h"
#include "estimator/odometry/start/plane_search.h"
#include "estimator/odometry/start/tile_flow.h"

namespace saccade {
namespace {

constexpr int kFirstRounds = 1;  ///< of every hypothesis, before the best goes on
constexpr int kRounds = 3;       ///< of the best
/// Of contrast: less may be noise, or a dense texture, of which the flow of tiles decides.
constexpr double kMinGain = 1.1;
constexpr double kMinParallax_px = 5;  ///< of the path at the typical depth: less is a rotation
/// Without a gyroscope the direction of motion must be known better than this.
constexpr double kMaxDirection_deg = 25;
constexpr double kMaxHalfDirection_deg = 45;  ///< by half of the window
constexpr int kFlowRounds = 3;  ///< each with the motion of the one before as the rough one
constexpr BurstLimits kFlowBursts{.gap = 0.15, .longest = 1};  ///< as of PlaneSearch
constexpr std::size_t kFlowEvents = 100000;                    ///< of a window
constexpr double kRetry_s = 0.1;  ///< where a window gives no start the next begins so much later
/// Each time that the camera moved and there still was none, the longer: the search of a long
/// recording without a start takes a time that grows with the logarithm of its length.
constexpr double kRetryGrowth = 1.2;

/// The events with from_s <= t < to_s, as seconds.
std::span<const Event> between(std::span<const Event> events, double from_s, double to_s) {
  const auto time_of = [](const Event& e) { return seconds_from_ns(e.t_ns); };
  const std::size_t first = count_before(events, from_s, time_of);
  return events.subspan(first, std::max(first, count_before(events, to_s, time_of)) - first);
}

/// `gyroscope` measures the rotation, where it is not empty.
Trajectory path_of(const PlaneFit& fit, const Gyroscope& gyroscope) {
  std::vector<StampedPose> poses;
  const double duration_s = fit.end_s - fit.start_s;
  const int steps = std::max(1, static_cast<int>(duration_s / kPoseSpacing_s));
  for (int i = 0; i <= steps; ++i) {
    const double t_s = fit.start_s + i * duration_s / steps;
    poses.push_back({t_s, fit.motion.reference_from_camera(t_s - fit.middle_s)});
  }
  rotate_by(gyroscope, poses, 1);
  return Trajectory(std::move(poses));
}

/// Parallax at depth 1 of the largest distance from the first pose [px].
double parallax_px(const Trajectory& path, const PinholeCamera& camera) {
  const Eigen::Vector3d first = path.poses().front().world_from_camera.translation();
  double most = 0;
  for (const StampedPose& pose : path.poses())
    most = std::max(most, (pose.world_from_camera.translation() - first).norm());
  return camera.fx * most;
}

/// From the first to the last pose of a fit's window, in the frame of its middle.
Eigen::Vector3d direction_over(const Trajectory& path, const PlaneFit& fit) {
  return path.at_clamped(fit.middle_s).rotation().conjugate() *
         (path.at_clamped(fit.end_s).translation() - path.at_clamped(fit.start_s).translation());
}

/// From the first pose on, in the unit asked for.
Trajectory in_world(const Trajectory& path, double depth_m) {
  const Rigid3 world_from_path = path.poses().front().world_from_camera.inverse();
  std::vector<StampedPose> poses;
  for (const StampedPose& pose : path.poses()) {
    const Rigid3 moved = world_from_path * pose.world_from_camera;
    poses.push_back({pose.t_s, {moved.rotation(), depth_m * moved.translation()}});
  }
  return Trajectory(std::move(poses));
}

class StartFinder {
 public:
  StartFinder(const PinholeCamera& camera, const BootstrapOptions& options,
              const Gyroscope& gyroscope)
      : camera_(camera),
        options_(options),
        gyroscope_(gyroscope),
        search_(options.max_search_s, camera, gyroscope),
        flow_filter_(camera, kFlowBursts, kFlowEvents),
        refinement_(measuring_rotation(options.refinement, gyroscope), camera) {}

  Bootstrap from(std::span<const Event> events) {
    Bootstrap start;
    const std::vector<PlaneFit> fits = search_.find(events);
    if (fits.empty()) return start;
    const bool is_sharp = fits.front().gain >= kMinGain;
    std::vector<PlaneFit> candidates = fits;
    if (gyroscope_.is_empty()) {
      const FlowStart by_flow = told_by_flow(events, fits.front());
      if (is_sharp || by_flow.has_tiles) start.status = Bootstrap::Status::kAmbiguous;
      if (!by_flow.fit) return start;
      candidates = {*by_flow.fit};
    } else if (!is_sharp) {
      return start;
    }
    start.status = Bootstrap::Status::kNoParallax;
    const FreePath path = grown(events, best_of(events, candidates));
    start.edges = path.edges;
    start.residual_px = path.residual_px;
    start.parallax_px = parallax_px(path.poses, camera_);
    // Edges that hardly tell may lead the path away from what the flow says.
    if (gyroscope_.is_empty() && path.is_clear &&
        angle_deg(direction_over(path.poses, candidates.front()),
                  candidates.front().motion.velocity) > kMaxDirection_deg) {
      start.status = Bootstrap::Status::kAmbiguous;
      return start;
    }
    if (path.is_clear && start.parallax_px >= kMinParallax_px) {
      start.status = Bootstrap::Status::kFound;
      start.path = in_world(path.poses, options_.depth_m);
    }
    return start;
  }

 private:
  struct FlowStart {
    bool has_tiles = false;       ///< enough of them for a motion
    std::optional<PlaneFit> fit;  ///< nullopt: they do not tell the direction of motion
  };

  /// What the flow of tiles makes of a fit. The whole window must tell the direction, and so must
  /// each half where no trial follows: a rotation that changes within the window is explained by a
  /// wrong translation, which hardly ever is one for both halves. A trial tells such starts as well,
  /// and does not refuse those whose halves are too short to tell anything.
  [[nodiscard]] FlowStart told_by_flow(std::span<const Event> events, PlaneFit fit) {
    FlowStart start;
    const std::span<const Event> window = between(events, fit.start_s, fit.end_s + kPoseSpacing_s);
    for (int i = 0; i < kFlowRounds; ++i) {
      const bool is_last = i + 1 == kFlowRounds;
      const std::optional<FlowMotion> found = motion_by_flow(window, fit.motion, is_last);
      if (!found) return start;
      start.has_tiles = true;
      fit.motion = {found->velocity, found->rate, Eigen::Vector2d::Zero()};
      if (is_last && found->direction_deg > kMaxDirection_deg) return start;
    }
    const double longest_s = std::max(fit.end_s, fit.start_s + options_.window_s);
    if (longest_s + kStartTrial_s <= seconds_from_ns(events.back().t_ns)) {
      start.fit = fit;
      return start;
    }
    const double middle_s = (fit.start_s + fit.end_s) / 2,
                 quarter_s = (fit.end_s - fit.start_s) / 4;
    const auto agrees = [&](double from_s, double to_s, const PlaneMotion& expected) {
      const std::optional<FlowMotion> half =
          motion_by_flow(between(window, from_s, to_s), expected, true);
      return half && half->direction_deg <= kMaxHalfDirection_deg &&
             angle_deg(half->velocity, expected.velocity) <= kMaxHalfDirection_deg;
    };
    if (agrees(fit.start_s, middle_s, fit.motion.seen_at(-quarter_s)) &&
        agrees(middle_s, fit.end_s, fit.motion.seen_at(quarter_s)))
      start.fit = fit;
    return start;
  }

  [[nodiscard]] std::optional<FlowMotion> motion_by_flow(std::span<const Event> window,
                                                         const PlaneMotion& rough,
                                                         bool is_spread_asked) {
    if (window.empty()) return std::nullopt;
    const std::vector<TileFlow> flows =
        tile_flows(window, flow_filter_, camera_.undistorted(), rough);
    if (flows.size() < kLeastTiles) return std::nullopt;
    return fit_motion(flows, is_spread_asked);
  }

  [[nodiscard]] FreePath best_of(std::span<const Event> events,
                                 const std::vector<PlaneFit>& fits) const {
    FreePath best;
    for (const PlaneFit& fit : fits) {
      FreePath path = refined(events, path_of(fit, gyroscope_), kFirstRounds);
      if (best.poses.empty() || path.events > best.events) best = std::move(path);
    }
    return refined(events, best.poses, kRounds);
  }

  [[nodiscard]] FreePath grown(std::span<const Event> events, FreePath path) const {
    const double start_s = path.poses.start_s();
    const double longest_s =
        std::min(options_.window_s, seconds_from_ns(events.back().t_ns) - start_s);
    while (path.is_clear && path.poses.end_s() - start_s < longest_s - kPoseSpacing_s) {
      const double window_s = std::min(options_.growth * (path.poses.end_s() - start_s), longest_s);
      path = refined(events, extrapolated(path.poses, start_s + window_s, gyroscope_), 1);
    }
    return path;
  }

  [[nodiscard]] FreePath refined(std::span<const Event> events, const Trajectory& path,
                                 int rounds) const {
    return refinement_.refine(between(events, path.start_s(), path.end_s()), path, rounds);
  }

  PinholeCamera camera_;
  BootstrapOptions options_;
  const Gyroscope& gyroscope_;
  PlaneSearch search_;
  BurstFilter flow_filter_;
  PathRefinement refinement_;
};

}  // namespace

Bootstrap find_start(std::span<const Event> events, const PinholeCamera& camera,
                     const BootstrapOptions& options, const Gyroscope& gyroscope) {
  Bootstrap start;
  if (events.empty()) return start;
  StartFinder finder(camera, options, gyroscope);
  const double end_s = seconds_from_ns(events.back().t_ns);
  double from_s = seconds_from_ns(events.front().t_ns), retry_s = kRetry_s;
  while (!events.empty()) {
    const Bootstrap found = finder.from(events);
    // Where the camera moved at some time, that is what there is to say.
    if (found.status != Bootstrap::Status::kNoMotion) start = found;
    if (found.status == Bootstrap::Status::kFound) break;
    if (found.status != Bootstrap::Status::kNoMotion) retry_s *= kRetryGrowth;
    from_s += retry_s;
    if (from_s >= end_s) break;
    events = between(events, from_s, end_s);
  }
  return start;
}

}  // namespace saccade
