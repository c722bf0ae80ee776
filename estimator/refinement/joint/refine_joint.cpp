#include "estimator/refinement/refinement_config.h"

#include <fmt/core.h>

#include <algorithm>
#include <limits>

#include "core/error.h"
#include "core/io/covariance_file.h"
#include "core/io/run/keyframe_list.h"
#include "core/median.h"
#include "core/process/parallel.h"
#include "core/process/progress.h"
#include "core/stopwatch.h"
#include "estimator/edges/least_squares/path_covariance.h"
#include "estimator/odometry/metric_world.h"
#include "estimator/odometry/odometry_config.h"
#include "estimator/odometry/odometry_output.h"
#include "estimator/odometry/start/given_poses.h"
#include "estimator/run/repeat.h"
#include "estimator/run/run_input.h"
#include "estimator/tracking/pose_output.h"

namespace saccade {
namespace {

/// The whole run as its refinement needs it.
struct BatchRun {
  OdometryConfig odometry;
  std::vector<TrackedPose> poses;
  std::vector<KeyframeEntry> keyframes;
  Events events;
  RunRecord::Window window;
  BatchInput batch;
};

/// The poses that the run was given until `until_s`; none where it found its start.
Trajectory start_poses(const RunRequest& request, const Dataset& dataset, const SourceRun& run,
                       const StartOptions& start, double from_s, double until_s) {
  if (!(start.truth_s > 0)) return {};
  RunRequest as_then = request;
  if (!run.record.poses_from.empty()) as_then.poses_from = run.record.poses_from;
  as_then.smooth_poses_s = run.record.smooth_poses_s;
  return given_start(as_then, dataset, from_s, until_s, start.time_offset_s);
}

BatchRun load(const RunRequest& request, const Dataset& dataset, const SourceRun& run) {
  BatchRun input;
  input.odometry = run.config<OdometryConfig>();
  input.poses = run.poses();
  input.keyframes = read_keyframe_list(run.folder / "keyframes.yaml");
  if (input.keyframes.empty())
    throw InputError((run.folder / "keyframes.yaml").string(),
                     "holds no keyframe: nothing to refine");
  const bool has_truth = input.odometry.start.truth_s > 0;
  if (!run.record.window)
    throw InputError(run.folder.string(), "does not say where its given start ends");
  // The run's window begins where the given start ends; the events of the start belong to it.
  input.events = load_events(request, dataset);
  input.window = *run.record.window;
  const double first_s = seconds_from_ns(input.events.front().t_ns);
  BatchInput& batch = input.batch;
  std::vector<StampedPose> given;
  for (const StampedPose& pose :
       start_poses(request, dataset, run, input.odometry.start, first_s, input.window.start_s)
           .poses())
    if (pose.t_s >= first_s) given.push_back(pose);
  std::vector<StampedPose> found =
      poses_not_lost(input.poses, input.window.start_s, seconds_from_ns(input.events.back().t_ns),
                     run.folder.string());
  // Without given poses the first that was found fixes the position.
  if (!has_truth) given.assign(1, found.front());
  batch.is_metric = has_truth;
  batch.path = given;
  for (const StampedPose& pose : found)
    if (batch.path.empty() || pose.t_s > batch.path.back().t_s) batch.path.push_back(pose);
  batch.given = std::move(given);
  std::vector<double> depths;
  for (const KeyframeEntry& keyframe : input.keyframes) {
    batch.keyframe_s.push_back(keyframe.t_s);
    depths.push_back(keyframe.typical_depth_m);
  }
  batch.typical_depth_m = median(std::move(depths));
  return input;
}

/// The poses of the run, replaced by those of the path, and their covariances.
std::vector<StampedCovariance> replace_poses(const BatchAdjustment& result,
                                             std::vector<TrackedPose>& poses) {
  for (TrackedPose& pose : poses) {
    pose.world_from_camera = result.path.at_clamped(seconds_from_ns(pose.t_ns));
    pose.status = TrackStatus::kOk;
    pose.iterations = static_cast<int>(result.costs.steps().size());
    pose.inlier_ratio = 1;
    pose.residual = result.residual_px;
    // What the run said of its own pose does not hold of this one.
    pose.probability = std::numeric_limits<double>::quiet_NaN();
  }
  if (result.covariances.empty()) return {};
  return set_sigmas(poses, [&](double t_s) { return result.covariance_at(t_s); });
}

/// The path in metres and a world whose z axis points up.
void transform_to_metric_world(BatchAdjustment& result) {
  std::vector<StampedPose> poses(result.path.poses().begin(), result.path.poses().end());
  for (StampedPose& pose : poses)
    pose.world_from_camera = in_metric_world(*result.inertial, pose.world_from_camera);
  result.path = Trajectory(std::move(poses));
  for (auto& covariance : result.covariances)
    for (Eigen::Index i = 0; i < covariance.rows(); ++i) {
      if (i % PathCorrection::kSize >= 3) continue;
      covariance.row(i) *= result.inertial->scale;
      covariance.col(i) *= result.inertial->scale;
    }
}

/// The run's keyframes with their depth on the refined path.
std::vector<Keyframe> keyframes_on(const BatchRun& run, const Trajectory& path,
                                   const PinholeCamera& camera, const RayDepth& depth,
                                   double window_s) {
  std::vector<Keyframe> keyframes(run.keyframes.size());
  parallel_for(keyframes.size(), [&](std::size_t k) {
    Keyframe& keyframe = keyframes[k];
    keyframe.t_s = run.keyframes[k].t_s;
    keyframe.world_from_camera = path.at_clamped(keyframe.t_s);
    keyframe.start_s = std::max(path.start_s(), keyframe.t_s - window_s / 2);
    keyframe.end_s = std::min(path.end_s(), keyframe.t_s + window_s / 2);
    keyframe.depth =
        depth.estimate({events_of_view(run.events, keyframe.t_s, window_s), &path, keyframe.t_s});
    keyframe.edges = points_in_world(keyframe.depth, camera, keyframe.world_from_camera);
  });
  return keyframes;
}

}  // namespace

RunSummary refine_joint(const RunRequest& request, const RefinementConfig& config,
                        const Dataset& dataset, const SourceRun& run, RunWriter& writer) {
  RunTiming timing;
  std::optional<ScopedTimer> io(timing.io_s);
  BatchRun input = load(request, dataset, run);
  if (config.joint.use_imu) input.batch.imu = load_mounted_imu(dataset, "joint.use_imu");
  io.reset();
  const DepthConfig& method = input.odometry.odometry.mapping.depth;
  const PinholeCamera camera = input.odometry.camera.of(dataset.camera());
  const RayDepth depth(method.rays, method.limits, camera);
  BatchAdjustment result;
  Progress progress("refine", config.joint.steps() * static_cast<std::size_t>(request.repeat),
                    "steps");
  repeat_timed(request.repeat, timing.wall_s, [&] {
    result = adjust_batch(input.events, input.batch, camera, depth, config.joint,
                          [&](std::size_t n) { progress.add(n); });
  });
  const bool is_scaled = !input.batch.is_metric && result.inertial &&
                         result.inertial->status == InertialAlignment::Status::kOk;
  if (is_scaled) {
    transform_to_metric_world(result);
    for (KeyframeEntry& keyframe : input.keyframes)
      keyframe.typical_depth_m *= result.inertial->scale;
  }
  const Stopwatch mapping;
  const std::vector<Keyframe> keyframes =
      keyframes_on(input, result.path, camera.undistorted(), depth, config.joint.window_s);
  const double depth_s = mapping.seconds();
  for (std::size_t k = 0; k < keyframes.size(); ++k) {
    KeyframeEntry& entry = input.keyframes[k];
    entry.world_from_camera = keyframes[k].world_from_camera;
    entry.points = entry.edges = static_cast<std::int64_t>(keyframes[k].edges.size());
  }
  timing.stages_s = {{"adjustment", timing.wall_s.back()}, {"depth", depth_s}};
  timing.events = input.events.size();
  timing.poses = input.poses.size();
  timing.sequence_s = input.window.end_s - input.window.start_s;

  io.emplace(timing.io_s);
  const auto covariances = replace_poses(result, input.poses);
  write_poses(writer.path(), input.poses);
  if (!covariances.empty()) write_covariances(writer.path() / "covariance.txt", covariances);
  // What brought the run that this one starts from into metres still holds.
  const std::filesystem::path inertial = writer.path() / "inertial.yaml";
  if (result.inertial && (is_scaled || !std::filesystem::exists(inertial)))
    write_inertial_alignment(inertial, *result.inertial, is_scaled);
  result.costs.save(writer.path() / "cost.csv");
  write_keyframes(writer.path(), camera.undistorted(), keyframes, input.keyframes);
  io.reset();
  writer.finish("refine", request, dataset, input.window, config.seed, config::print(config),
                timing);

  return summary_of(
      timing,
      fmt::format("{} poses and {} keyframes by {} events, residual {:.3f} px", input.poses.size(),
                  input.keyframes.size(), result.observations, result.residual_px));
}

}  // namespace saccade
