#include "estimator/refinement/refine_joint.h"

#include <fmt/core.h>

#include <algorithm>

#include "core/error.h"
#include "core/io/covariance_file.h"
#include "core/io/keyframe_list.h"
#include "core/io/view_list.h"
#include "core/median.h"
#include "core/parallel.h"
#include "core/progress.h"
#include "core/stopwatch.h"
#include "estimator/depth/depth_output.h"
#include "estimator/odometry/metric_world.h"
#include "estimator/odometry/odometry_config.h"
#include "estimator/refinement/joint_poses.h"
#include "estimator/refinement/keyframe_windows.h"
#include "estimator/run/run_input.h"
#include "estimator/tracking/pose_output.h"

namespace saccade {
namespace {

/// The whole run as its refinement needs it.
struct JointInput {
  OdometryConfig odometry;
  std::vector<TrackedPose> poses;
  std::vector<KeyframeEntry> keyframes;
  Events events;
  RunRecord::Window window;
  JointStart start;
};

JointInput load(const RunRequest& request, const Dataset& dataset, const SourceRun& run) {
  JointInput input;
  input.odometry = run.config<OdometryConfig>();
  input.poses = run.poses();
  input.keyframes = read_keyframe_list(run.folder / "keyframes.yaml");
  if (input.keyframes.empty())
    throw InputError((run.folder / "keyframes.yaml").string(),
                     "holds no keyframe: nothing to refine");
  const bool has_truth = input.odometry.start.truth_s > 0;
  if (!run.record.window || (has_truth && dataset.groundtruth().empty()))
    throw InputError(run.folder.string(), "does not say where its given start ends");
  // The run's window begins where the given start ends; the events of the start belong to it.
  input.events = load_events(request, dataset);
  input.window = *run.record.window;
  const double first_s = seconds_from_ns(input.events.front().t_ns);
  JointStart& start = input.start;
  std::vector<StampedPose> known;
  for (StampedPose pose : dataset.groundtruth().poses()) {
    if (!has_truth) break;
    pose.t_s += input.odometry.start.time_offset_s;
    if (pose.t_s >= first_s && pose.t_s <= input.window.start_s) known.push_back(pose);
  }
  std::vector<StampedPose> found =
      known_path(input.poses, input.window.start_s, seconds_from_ns(input.events.back().t_ns),
                 run.folder.string());
  // Without given poses the first that was found holds the place.
  if (!has_truth) known.assign(1, found.front());
  start.is_metric = has_truth;
  start.path = known;
  for (const StampedPose& pose : found)
    if (start.path.empty() || pose.t_s > start.path.back().t_s) start.path.push_back(pose);
  start.known = std::move(known);
  std::vector<double> depths;
  for (const KeyframeEntry& keyframe : input.keyframes) {
    start.keyframe_s.push_back(keyframe.t_s);
    depths.push_back(keyframe.typical_depth_m);
  }
  start.typical_depth_m = median(std::move(depths));
  return input;
}

std::vector<StampedCovariance> take(const JointResult& result, std::vector<TrackedPose>& poses) {
  for (TrackedPose& pose : poses) {
    pose.world_from_camera = result.path.at_clamped(seconds_from_ns(pose.t_ns));
    pose.status = TrackStatus::kOk;
    pose.iterations = static_cast<int>(result.costs.steps().size());
    pose.inlier_ratio = 1;
    pose.residual = result.residual_px;
  }
  return take_sigmas(result, poses);
}

/// The path in metres and a world whose z axis points up.
void take_into_metres(JointResult& result) {
  const double scale = result.inertial->scale;
  const Eigen::Quaterniond gravity_alignment = result.inertial->gravity_alignment();
  std::vector<StampedPose> poses(result.path.poses().begin(), result.path.poses().end());
  for (StampedPose& pose : poses) {
    const Rigid3& before = pose.world_from_camera;
    pose.world_from_camera = Rigid3(gravity_alignment * before.rotation(),
                                    gravity_alignment * (scale * before.translation()));
  }
  result.path = Trajectory(std::move(poses));
  for (Eigen::Index i = 0; i < result.covariance.rows(); ++i) {
    if (i % PathCorrection::kSize >= 3) continue;
    result.covariance.row(i) *= scale;
    result.covariance.col(i) *= scale;
  }
}

/// Depths of the keyframes on the refined path.
std::vector<DepthResult> depths_on(const JointInput& input, const Trajectory& path,
                                   const RayDepth& depth, double window_s) {
  std::vector<DepthResult> results(input.keyframes.size());
  parallel_for(results.size(), [&](std::size_t k) {
    const double t_s = input.keyframes[k].t_s;
    results[k] = depth.estimate({events_around(input.events, t_s, window_s), &path, t_s});
  });
  return results;
}

void write_keyframes(const std::filesystem::path& folder, const PinholeCamera& camera,
                     JointInput& input, const Trajectory& path,
                     const std::vector<DepthResult>& depths, double window_s) {
  std::filesystem::create_directories(folder / "depth");
  std::vector<RunView> views;
  MapPoints map;
  for (std::size_t k = 0; k < depths.size(); ++k) {
    KeyframeEntry& keyframe = input.keyframes[k];
    keyframe.world_from_camera = path.at_clamped(keyframe.t_s);
    keyframe.points = keyframe.edges = static_cast<std::int64_t>(depths[k].points.size());
    RunView view;
    view.t_s = keyframe.t_s;
    view.world_from_camera = keyframe.world_from_camera;
    view.start_s = std::max(path.start_s(), keyframe.t_s - window_s / 2);
    view.end_s = std::min(path.end_s(), keyframe.t_s + window_s / 2);
    view.depth = folder / "depth" / fmt::format("depth_{:08}.exr", k);
    write_depth_map(view.depth, camera, depths[k]);
    views.push_back(view);
    for (const EdgeDepth& point : depths[k].points) {
      const Eigen::Vector3d in_world =
          view.world_from_camera *
          (camera.ray({point.x_px, point.y_px}) / static_cast<double>(point.inverse_depth));
      map.x.push_back(static_cast<float>(in_world.x()));
      map.y.push_back(static_cast<float>(in_world.y()));
      map.z.push_back(static_cast<float>(in_world.z()));
    }
  }
  write_view_list(folder / "views.yaml", views);
  write_keyframe_list(folder / "keyframes.yaml", input.keyframes);
  write_map(folder / "map.ply", map, Rigid3());
}

}  // namespace

RunSummary refine_joint(const RunRequest& request, const RefinementConfig& config,
                        const Dataset& dataset, const SourceRun& run, RunWriter& writer) {
  RunTiming timing;
  std::optional<ScopedTimer> io(timing.io_s);
  JointInput input = load(request, dataset, run);
  if (config.joint.imu.use) input.start.imu = load_mounted_imu(dataset, "joint.imu.use");
  io.reset();
  const DepthConfig& method = input.odometry.odometry.mapping.depth;
  const PinholeCamera camera = input.odometry.camera.of(dataset.camera());
  const RayDepth depth(method.rays, method.limits, camera);
  JointResult result;
  Progress progress("refine", config.joint.steps() * static_cast<std::size_t>(request.repeat),
                    "steps");
  for (int i = 0; i < request.repeat; ++i) {
    double wall_s = 0;
    {
      const ScopedTimer clock(wall_s);
      result = refine_jointly(input.events, input.start, camera, depth, config.joint,
                              [&](std::size_t n) { progress.add(n); });
    }
    timing.wall_s.push_back(wall_s);
  }
  const bool is_scaled = result.inertial && !input.start.is_metric;
  if (is_scaled) {
    take_into_metres(result);
    for (KeyframeEntry& keyframe : input.keyframes)
      keyframe.typical_depth_m *= result.inertial->scale;
  }
  double depth_s = 0;
  std::vector<DepthResult> depths;
  {
    const ScopedTimer clock(depth_s);
    depths = depths_on(input, result.path, depth, config.joint.window_s);
  }
  timing.stages_s = {{"adjustment", timing.wall_s.back()}, {"depth", depth_s}};
  timing.events = input.events.size();
  timing.poses = input.poses.size();
  timing.sequence_s = input.window.end_s - input.window.start_s;

  io.emplace(timing.io_s);
  const auto covariances = take(result, input.poses);
  write_poses(writer.path(), input.poses);
  if (!covariances.empty()) write_covariances(writer.path() / "covariance.txt", covariances);
  if (result.inertial)
    write_inertial_alignment(writer.path() / "inertial.yaml", *result.inertial, is_scaled);
  result.costs.save(writer.path() / "cost.csv");
  write_keyframes(writer.path(), camera.undistorted(), input, result.path, depths,
                  config.joint.window_s);
  io.reset();
  writer.finish("refine", request, dataset, input.window, config.seed, config::print(config),
                timing);

  RunSummary summary;
  summary.events = input.events.size();
  summary.poses = input.poses.size();
  summary.found =
      fmt::format("{} poses and {} keyframes by {} events, residual {:.3f} px", summary.poses,
                  input.keyframes.size(), result.observations, result.residual_px);
  summary.wall_s = median(timing.wall_s);
  return summary;
}

}  // namespace saccade
