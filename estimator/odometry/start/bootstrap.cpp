#include "estimator/odometry/start/bootstrap.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "core/time_search.h"
#include "estimator/odometry/start/extrapolated_path.h"
#include "estimator/odometry/start/flow_motion.h"
#include "estimator/odometry/start/plane_search.h"
#include "estimator/odometry/start/start_trial.h"
#include "estimator/odometry/start/tile_flow.h"

namespace saccade {
namespace {

constexpr int kFirstRounds = 1;  ///< of every motion with a gyroscope, before the best goes on
constexpr int kRounds = 3;       ///< of the best, and of every hypothesis without a gyroscope
/// Of contrast: less may be noise, or a dense texture, of which the flow of tiles decides.
constexpr double kMinGain = 1.1;
/// Where the direction of motion is known less well by the flow than this, a rotation alone is tried, too.
constexpr double kToldDirection_deg = 25;
constexpr double kMinParallax_px = 5;       ///< of a path with a gyroscope, at the typical depth
constexpr std::size_t kMostHypotheses = 4;  ///< about motions: each is refined by itself
constexpr double kSame_px = 1;  ///< hypotheses whose refined paths move the image alike are one
/// Of the greatest evidence: with so much, the path of least parallax is taken. Free depths explain
/// noise the better, the more parallax there is (parallax_prior.h), and events are not independent.
constexpr double kLikely = 0.7;
/// A translation and a rotation of the same image motion are freed by sigmas of the ratio of the
/// motion's own, at most this or its inverse, as nothing moves in one way alone for long; but for the
/// hypothesis that the camera only turns.
constexpr double kMostRatio = 4;
/// A hand that shakes at 6 Hz bends its path within 0.02 s.
constexpr double kNodeSpacing_s = 0.01;
/// By which a path is extrapolated, as image motion: edges are found again within some pixels, and a
/// shaken camera turns round within 20 of them.
constexpr double kStep_px = 2;
constexpr int kFlowRounds = 3;  ///< each with the motion of the one before as the rough one
constexpr BurstLimits kFlowBursts{.gap = 0.15, .longest = 1};  ///< as of PlaneSearch
constexpr std::size_t kFlowEvents = 100000;                    ///< of a window

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

/// From the first pose on.
Rigid3 change(const Trajectory& path, double until_s) {
  return path.poses().front().world_from_camera.inverse() * path.at_clamped(until_s);
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

/// Shares out what a rotation and the translation that looks like it have in common, as the motion does.
PathRefinementOptions sharing(const PlaneMotion& motion, PathRefinementOptions options) {
  constexpr double kNoTranslation = 1e3;
  const double speed = motion.velocity.norm();
  const double ratio = speed > 0
                           ? std::clamp(motion.rate.norm() / speed, 1 / kMostRatio, kMostRatio)
                           : kNoTranslation;
  WindowAdjustmentOptions& adjustment = options.adjustment;
  adjustment.rotation_sigma_ratio = ratio;
  // The sigmas are of translations: the larger of both keeps its own.
  adjustment.smoothness_sigma_px /= std::max(1.0, ratio);
  adjustment.pose_sigma_px /= std::max(1.0, ratio);
  return options;
}

/// Log likelihood of the events on edges beside that of events anywhere within a pixel of them.
double evidence(const FreePath& path) {
  constexpr double kReach_px = 1, kLeastSigma_px = 0.01;
  const double sigma_px = std::max(path.residual_px, kLeastSigma_px);
  const double of_each = std::log(2 * kReach_px / (sigma_px * std::sqrt(2 * M_PI * M_E)));
  return static_cast<double>(path.events) * std::max(0.0, of_each);
}

class StartFinder {
 public:
  StartFinder(const PinholeCamera& camera, const BootstrapOptions& options,
              const Gyroscope& gyroscope)
      : camera_(camera),
        options_(gyroscope.is_empty() ? of_events_alone(options) : options),
        gyroscope_(gyroscope),
        search_(options.max_search_s, camera, gyroscope),
        flow_filter_(camera, kFlowBursts, kFlowEvents),
        refinement_(measuring_rotation(options_.refinement, gyroscope), camera) {}

  Bootstrap from(std::span<const Event> events) {
    Bootstrap start;
    const std::vector<PlaneFit> fits = search_.find(events);
    if (fits.empty()) return start;
    const bool is_sharp = fits.front().gain >= kMinGain;
    std::optional<FreePath> path;
    if (gyroscope_.is_empty()) {
      const FlowStart by_flow = told_by_flow(events, fits.front());
      if (is_sharp || by_flow.has_tiles) start.status = Bootstrap::Status::kUnexplained;
      path = most_likely(events, by_flow.hypotheses);
    } else if (is_sharp) {
      start.status = Bootstrap::Status::kUnexplained;
      path = grown(refinement_, events, best_of(events, fits));
    }
    if (!path || !path->is_clear) return start;
    // What a gyroscope measures is no evidence of a start of edges that hardly move.
    if (!gyroscope_.is_empty() && parallax_px(path->poses, camera_) < kMinParallax_px) return start;
    start.status = Bootstrap::Status::kFound;
    start.path = in_world(path->poses, options_.depth_m);
    start.edges = path->edges;
    start.residual_px = path->residual_px;
    start.parallax_px = parallax_px(path->poses, camera_);
    return start;
  }

 private:
  struct FlowStart {
    bool has_tiles = false;            ///< enough of them for a motion
    std::vector<PlaneFit> hypotheses;  ///< the likeliest first
  };

  /// Where nothing but the edges tells a rotation from a translation.
  static BootstrapOptions of_events_alone(BootstrapOptions options) {
    WindowAdjustmentOptions& adjustment = options.refinement.adjustment;
    adjustment.node_spacing_s = std::min(adjustment.node_spacing_s, kNodeSpacing_s);
    options.refinement.enough_edges = static_cast<std::size_t>(adjustment.edges);
    return options;
  }

  /// What the flow of tiles makes of a fit. Where it does not tell the direction of motion, several
  /// are likely, and that there is none: the camera may only turn.
  [[nodiscard]] FlowStart told_by_flow(std::span<const Event> events, PlaneFit fit) {
    FlowStart start;
    const std::span<const Event> window = between(events, fit.start_s, fit.end_s + kPoseSpacing_s);
    std::optional<FlowMotion> found;
    for (int i = 0; i < kFlowRounds; ++i) {
      found = motion_by_flow(window, fit.motion, i + 1 == kFlowRounds);
      if (!found) return start;
      start.has_tiles = true;
      fit.motion = {found->velocity, found->rate, Eigen::Vector2d::Zero()};
    }
    // Nothing would tell a wrong hypothesis.
    const double longest_s = std::max(fit.end_s, fit.start_s + options_.window_s);
    const bool has_trial = longest_s + kStartTrial_s / 2 <= seconds_from_ns(events.back().t_ns);
    if (!has_trial && found->direction_deg > kToldDirection_deg) return start;
    const auto add = [&](const Eigen::Vector3d& velocity, const Eigen::Vector3d& rate) {
      if (start.hypotheses.size() == kMostHypotheses) return;
      start.hypotheses.push_back(fit);
      start.hypotheses.back().motion = {velocity, rate, Eigen::Vector2d::Zero()};
    };
    add(found->velocity, found->rate);
    if (found->direction_deg > kToldDirection_deg) add(Eigen::Vector3d::Zero(), found->rotation);
    for (const FlowMotion& other : found->others) add(other.velocity, other.rate);
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

  /// The path of least parallax among the likely ones; nullopt: no hypothesis explains the events.
  [[nodiscard]] std::optional<FreePath> most_likely(std::span<const Event> events,
                                                    const std::vector<PlaneFit>& hypotheses) const {
    std::vector<Trajectory> begun;
    std::vector<FreePath> paths;
    double most = 0;
    for (const PlaneFit& hypothesis : hypotheses) {
      const PathRefinement refinement(sharing(hypothesis.motion, options_.refinement), camera_);
      FreePath path = refined(refinement, events, path_of(hypothesis, gyroscope_), kRounds);
      if (!path.is_clear) continue;
      const bool is_new = std::none_of(begun.begin(), begun.end(), [&](const Trajectory& other) {
        return apart_px(path.poses, other) < kSame_px;
      });
      if (!is_new) continue;
      begun.push_back(path.poses);
      path = grown(refinement, events, std::move(path));
      if (!path.is_clear) continue;
      most = std::max(most, evidence(path));
      paths.push_back(std::move(path));
    }
    std::optional<FreePath> least;
    for (FreePath& path : paths)
      if (evidence(path) > 0 && evidence(path) >= kLikely * most &&
          (!least || parallax_px(path.poses, camera_) < parallax_px(least->poses, camera_)))
        least = std::move(path);
    return least;
  }

  /// By how much two motions differ, of what is at depth 1.
  [[nodiscard]] double image_motion_px(const Rigid3& a, const Rigid3& b) const {
    const Twist difference = (a.inverse() * b).log();
    return camera_.fx * std::hypot(difference.head<3>().norm(), difference.tail<3>().norm());
  }

  /// The most that two paths of the same times differ, in their middle or in the end.
  [[nodiscard]] double apart_px(const Trajectory& a, const Trajectory& b) const {
    const double middle_s = (a.start_s() + a.end_s()) / 2;
    return std::max(image_motion_px(change(a, middle_s), change(b, middle_s)),
                    image_motion_px(change(a, a.end_s()), change(b, a.end_s())));
  }

  /// How fast a path moves the image in the end [px/s].
  [[nodiscard]] double speed_px(const Trajectory& path) const {
    constexpr double kLast_s = 0.02;  // as of extrapolated()
    const double last_s = std::min(kLast_s, path.end_s() - path.start_s());
    const Rigid3 before = path.at_clamped(path.end_s() - last_s);
    return image_motion_px(before, path.poses().back().world_from_camera) / last_s;
  }

  [[nodiscard]] FreePath best_of(std::span<const Event> events,
                                 const std::vector<PlaneFit>& fits) const {
    FreePath best;
    for (const PlaneFit& fit : fits) {
      FreePath path = refined(refinement_, events, path_of(fit, gyroscope_), kFirstRounds);
      if (best.poses.empty() || path.events > best.events) best = std::move(path);
    }
    return refined(refinement_, events, best.poses, kRounds);
  }

  /// Hands change their velocity: the extrapolated part goes on at the path's acceleration.
  [[nodiscard]] FreePath grown(const PathRefinement& refinement, std::span<const Event> events,
                               FreePath path) const {
    const double start_s = path.poses.start_s();
    const double longest_s =
        std::min(options_.window_s, seconds_from_ns(events.back().t_ns) - start_s);
    while (path.is_clear && path.poses.end_s() - start_s < longest_s - kPoseSpacing_s) {
      const double length_s = path.poses.end_s() - start_s;
      if (!gyroscope_.is_empty()) {
        const double until_s = start_s + std::min(options_.growth * length_s, longest_s);
        path = refined(refinement, events, extrapolated(path.poses, until_s, gyroscope_), 1);
        continue;
      }
      const double step_s = std::max(2 * kPoseSpacing_s, kStep_px / speed_px(path.poses));
      const double window_s = std::min({options_.growth * length_s, length_s + step_s, longest_s});
      const Trajectory longer =
          extrapolated(path.poses, start_s + window_s, gyroscope_, last_acceleration(path.poses));
      path = refined(refinement, events, longer, 1);
    }
    return path;
  }

  [[nodiscard]] static FreePath refined(const PathRefinement& refinement,
                                        std::span<const Event> events, const Trajectory& path,
                                        int rounds) {
    return refinement.refine(between(events, path.start_s(), path.end_s()), path, rounds);
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
  double from_s = seconds_from_ns(events.front().t_ns), retry_s = kStartRetry_s;
  while (!events.empty()) {
    const Bootstrap found = finder.from(events);
    // Where the camera moved at some time, that is what there is to say.
    if (found.status != Bootstrap::Status::kNoMotion) start = found;
    if (found.status == Bootstrap::Status::kFound) break;
    if (found.status != Bootstrap::Status::kNoMotion) retry_s *= kStartRetryGrowth;
    from_s += retry_s;
    if (from_s >= end_s) break;
    events = between(events, from_s, end_s);
  }
  return start;
}

}  // namespace saccade
