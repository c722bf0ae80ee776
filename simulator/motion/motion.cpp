#include "simulator/motion/motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/io/trajectory_file.h"
#include "simulator/motion/presets.h"

namespace saccade {
namespace {

/// tx ty tz qx qy qz qw.
Rigid3 pose_from(std::span<const double> numbers) {
  const Eigen::Map<const Eigen::Vector3d> t(&numbers[0]);
  const Eigen::Map<const Eigen::Vector4d> q(&numbers[3]);
  return {Eigen::Quaterniond(q[3], q[0], q[1], q[2]), t};
}

/// world from trajectory, with its scale.
Rigid3 placed(const TransformOptions& transform, const Rigid3& pose) {
  const Eigen::Quaterniond rotation(rotation_of(transform.rotation_deg));
  return {rotation * pose.rotation(),
          rotation * (transform.scale.x() * pose.translation()) + transform.translation};
}

std::vector<StampedPose> waypoint_poses(const MotionOptions& options) {
  std::vector<StampedPose> poses;
  for (const std::vector<double>& w : options.waypoints)
    poses.push_back({w[0], pose_from(std::span(w).subspan(1))});
  if (!poses.empty()) return poses;
  for (const ViewOptions& view : options.views)
    poses.push_back({view.t_s, {orientation_at(view.orientation, view.position), view.position}});
  return poses;
}

/// After `rest_s` at the first of them.
std::vector<StampedPose> file_poses(const std::filesystem::path& file, double rest_s) {
  constexpr double kRestStep_s = 0.01;
  const Trajectory trajectory = read_trajectory(file);
  if (trajectory.size() < 2)
    throw InputError(file.string(), "holds one pose; a motion needs at least two");
  std::vector<StampedPose> poses;
  const StampedPose& first = trajectory.poses().front();
  const auto steps = static_cast<int>(std::ceil(rest_s / kRestStep_s));
  for (int i = 0; i < steps; ++i)
    poses.push_back({first.t_s + rest_s * i / steps, first.world_from_camera});
  for (const StampedPose& pose : trajectory.poses())
    poses.push_back({pose.t_s + rest_s, pose.world_from_camera});
  return poses;
}

Spline fitted(const MotionOptions& options, std::vector<StampedPose> poses,
              const std::string& location) {
  for (StampedPose& p : poses) {
    p.world_from_camera = placed(options.transform, p.world_from_camera);
  }
  try {
    return options.fit == Fit::kSmooth ? Spline::smooth(poses, options.knot_spacing_s)
                                       : Spline::interpolate(poses);
  } catch (const InputError& error) {
    throw InputError(location, error.what());
  }
}

Spline controlled(const MotionOptions& options) {
  const auto& rows = options.control_poses;
  const bool timed = rows.front().size() == 8;
  std::vector<Rigid3> poses;
  for (const std::vector<double>& row : rows) {
    const Rigid3 pose = pose_from(std::span(row).subspan(timed ? 1 : 0));
    poses.push_back(placed(options.transform, pose));
  }
  if (!timed) return Spline::from_control_poses(poses, 0, options.knot_spacing_s);
  const double spacing = (rows.back()[0] - rows.front()[0]) / static_cast<double>(rows.size() - 1);
  return Spline::from_control_poses(poses, rows.front()[0] + spacing, spacing);
}

/// Samples beyond both ends keep the natural ends' lack of acceleration out of the motion: their
/// influence falls by 3.7 per sample.
Spline sampled(const MotionOptions& options) {
  constexpr double kSamplesPerPeriod = 100;
  constexpr double kLongestStep = 0.01;
  constexpr int kBeyond = 16;
  const Preset preset = make_preset(options);
  const double wanted = std::min(
      {kLongestStep, preset.shortest_period_s / kSamplesPerPeriod, options.duration_s / 10});
  const int steps = static_cast<int>(std::ceil(options.duration_s / wanted));
  const double step = options.duration_s / steps;
  std::vector<StampedPose> poses;
  for (int i = -kBeyond; i <= steps + kBeyond; ++i) {
    const Rigid3 pose = preset.world_from_camera(i * step);
    poses.push_back({i * step, placed(options.transform, pose)});
  }
  return Spline::interpolate(poses).cut(0, options.duration_s);
}

}  // namespace

Spline build_motion(const MotionOptions& options, const std::string& name) {
  switch (options.source) {
    case MotionSource::kControlPoses:
      return controlled(options);
    case MotionSource::kWaypoints:
      return fitted(options, waypoint_poses(options), name + ".waypoints");
    case MotionSource::kFile:
      return fitted(options, file_poses(options.file, options.rest_s), options.file.string());
    case MotionSource::kModelCamera:
      return fitted(options, model_camera_poses(options.model_camera),
                    options.model_camera.file.string());
    default:
      return sampled(options);
  }
}

Spline cut_motion(const Spline& motion, double start_s, std::optional<double> duration_s) {
  // Spans are often written with a few decimals; what is beyond the end by less than this is the
  // end.
  constexpr double kTolerance = 1e-6;
  const double span = motion.end_s() - motion.start_s();
  if (!(start_s >= 0 && start_s < span))
    throw InputError(
        "start_s",
        fmt::format("{} s lies outside the trajectory, which lasts {:.9g} s", start_s, span));
  const double rest = span - start_s;
  const double duration = duration_s.value_or(rest);
  if (!(duration > 0))
    throw InputError("duration_s", fmt::format("must be above 0; it is {} s", duration));
  if (duration > rest + kTolerance)
    throw InputError("duration_s",
                     fmt::format("{} s from {} s on is more than the trajectory, which "
                                 "lasts {:.9g} s",
                                 duration, start_s, span));
  return motion.cut(motion.start_s() + start_s, std::min(duration, rest));
}

}  // namespace saccade
