#include "estimator/odometry/odometry_module.h"

#include <fmt/core.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "core/config/config.h"
#include "core/error.h"
#include "core/progress.h"
#include "estimator/odometry/odometry_config.h"
#include "estimator/odometry/odometry_output.h"
#include "estimator/odometry/start/start_record.h"
#include "estimator/run_input.h"
#include "estimator/run_writer.h"
#include "estimator/stage_clock.h"
#include "estimator/tracking/gyroscope_input.h"
#include "estimator/tracking/pose_output.h"

namespace saccade {
namespace {

/// The poses of the start. None beyond is looked at.
Trajectory start_poses(const Dataset& dataset, std::span<const Event> events,
                       const StartOptions& options) {
  const double from_s = seconds_from_ns(events.front().t_ns);
  const double whole_s = seconds_from_ns(events.back().t_ns) - from_s;
  const double truth_s = std::min(options.truth_s, options.truth_share * whole_s);
  std::vector<StampedPose> start;
  std::optional<StampedPose> before;
  for (StampedPose pose : dataset.groundtruth().poses()) {
    pose.t_s += options.time_offset_s;
    if (pose.t_s > from_s + truth_s) break;
    if (pose.t_s < from_s)
      before = pose;
    else
      start.push_back(pose);
  }
  if (before && (start.empty() || start.front().t_s > from_s)) start.insert(start.begin(), *before);
  if (start.size() < 2)
    throw InputError(
        dataset.folder().string(),
        fmt::format("groundtruth.txt holds fewer than two poses of the first {:.4g} s, "
                    "which start.truth_s asks for",
                    truth_s));
  return Trajectory(std::move(start));
}

/// The path at the start from events alone.
Bootstrap found_start(const Dataset& dataset, const PinholeCamera& camera,
                      std::span<const Event> events, const StartOptions& options) {
  Bootstrap start = find_start(events, camera, options.found);
  if (start.status == Bootstrap::Status::kNoMotion)
    throw InputError(dataset.folder().string(),
                     "the events show no motion that odometry could start from");
  if (start.status == Bootstrap::Status::kNoParallax)
    throw InputError(dataset.folder().string(),
                     "the events show no parallax that odometry could start from: the camera must "
                     "move sideways; of a camera that only turns see saccade run rotation");
  return start;
}

/// What is known at the start, and how it came to be known.
struct Start {
  KnownPath path;
  std::optional<Bootstrap> found;  ///< from events alone
  double from_s = 0;               ///< what is scored begins there
  double seconds = 0;              ///< of work
};

Start start_of(const Dataset& dataset, const PinholeCamera& camera, std::span<const Event> events,
               const StartOptions& options) {
  Start start;
  if (options.truth_s > 0) {
    start.path.poses = start_poses(dataset, events, options);
    start.path.settled_until_s = start.from_s = start.path.poses.end_s();
    return start;
  }
  const StageClock clock(start.seconds);
  start.found = found_start(dataset, camera, events, options);
  start.from_s = start.found->path.start_s();
  // All but the first pose may change.
  start.path = {start.found->path, start.from_s, options.found.depth_m, {}};
  return start;
}

}  // namespace

RunSummary run_odometry(const RunRequest& request) {
  OdometryConfig config = config::read<OdometryConfig>(request.config);
  if (request.seed) config.seed = *request.seed;
  check(request);
  RunWriter writer(request);

  RunTiming timing;
  std::optional<StageClock> io(timing.io_s);
  const Dataset dataset = Dataset::open(request.dataset);
  const PinholeCamera camera = config.camera.of(dataset.camera());
  const Events events = load_events(request, dataset);
  const Gyroscope gyroscope = load_gyroscope(config.odometry.tracker.motion, dataset);
  std::optional<MountedImu> imu;
  if (config.metric.align || config.odometry.last.joint.imu.use)
    imu = load_mounted_imu(dataset, "imu.align or last.imu.use");
  io.reset();
  const Start start = start_of(dataset, camera, events, config.start);

  // What is scored begins where the given poses end, or where those that were found begin.
  RunRecord::Window window =
      window_of(request, seconds_from_ns(events.front().t_ns), seconds_from_ns(events.back().t_ns));
  window.start_s = start.from_s;
  timing.events = events.size();
  timing.sequence_s = seconds_from_ns(events.back().t_ns - events.front().t_ns);

  OdometryResult result;
  double refine_s = 0;
  std::vector<StampedCovariance> covariances;
  std::optional<Odometry> odometry;
  Progress progress("odometry", events.size() * static_cast<std::size_t>(request.repeat), "events");
  for (int i = 0; i < request.repeat; ++i) {
    odometry.emplace(config.odometry, camera, config.seed);
    odometry->set_gyroscope(gyroscope);
    if (imu) odometry->set_imu(*imu);
    double wall_s = start.seconds;
    refine_s = 0;
    {
      const StageClock clock(wall_s);
      result = odometry->run(events, start.path, [&](std::size_t n) { progress.add(n); });
    }
    if (odometry->wants_refinement(result)) {
      const StageClock clock(refine_s);
      Progress refinement("refine", config.odometry.last.joint.steps(), "steps");
      covariances =
          odometry->refine(events, start.path, result, [&](std::size_t n) { refinement.add(n); });
    }
    timing.wall_s.push_back(wall_s + refine_s);
  }
  double images_s = 0;
  if (config.odometry.mapping.image) {
    const StageClock clock(images_s);
    Progress images("images", odometry->map().keyframes().size(), "keyframes");
    odometry->add_images(events, [&](std::size_t n) { images.add(n); });
  }
  timing.stages_s = {{"start", start.seconds},
                     {"tracking", result.tracking_s},
                     {"mapping", result.mapping_s},
                     {"refinement", refine_s},
                     {"images", images_s}};
  timing.poses = result.poses.size();
  timing.latency_ms = std::move(result.latency_ms);
  if (config.odometry.mode == OdometryMode::kOnline) timing.dropped_events = result.dropped_events;

  std::vector<Keyframe> keyframes = odometry->map().keyframes();
  std::optional<InertialAlignment> felt;
  if (config.metric.align) felt = align_odometry(result.poses, keyframes, *imu, config.metric);
  // Given poses have a world and metres of their own.
  const bool is_metric = felt && start.found && felt->status == InertialAlignment::Status::kOk;
  if (is_metric) take_into_metric_world(*felt, result.poses, keyframes, covariances);

  io.emplace(timing.io_s);
  write_odometry(writer.path(), camera, result, keyframes);
  if (!covariances.empty()) write_covariances(writer.path() / "covariance.txt", covariances);
  if (felt) write_inertial_alignment(writer.path() / "inertial.yaml", *felt, is_metric);
  if (start.found)
    write_start(writer.path() / "start.yaml", *start.found, config.start.found.depth_m);
  io.reset();
  writer.finish("odometry", request, dataset, window, config.seed, config::print(config), timing);

  RunSummary summary;
  summary.events = events.size();
  summary.poses = result.poses.size();
  summary.lost_poses = count_lost(result.poses);
  summary.found = fmt::format("{} poses ({} lost) by {} keyframes", summary.poses,
                              summary.lost_poses, odometry->map().keyframes().size());
  if (felt)
    summary.found +=
        fmt::format(", scale {:.4g} +- {:.2g} %", felt->scale, 100 * felt->scale_sigma);
  summary.wall_s = median(timing.wall_s);
  return summary;
}

std::string print_odometry_config(const config::Document& document) {
  return config::print_documented(config::read<OdometryConfig>(document));
}

}  // namespace saccade
