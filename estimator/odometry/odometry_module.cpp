#include "estimator/odometry/odometry_module.h"

#include <fmt/core.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/config/config.h"
#include "core/error.h"
#include "core/io/run/path_so_far.h"
#include "core/process/progress.h"
#include "core/stopwatch.h"
#include "core/time_search.h"
#include "estimator/odometry/metric_world.h"
#include "estimator/odometry/odometry_config.h"
#include "estimator/odometry/odometry_output.h"
#include "estimator/odometry/start/given_poses.h"
#include "estimator/run/run_input.h"
#include "estimator/run/run_writer.h"
#include "estimator/tracking/check/pose_monitor.h"
#include "estimator/tracking/motion_model.h"
#include "estimator/tracking/pose_output.h"

namespace saccade {
namespace {

/// The given poses of the start, of the ground truth or of --poses-from.
Trajectory start_poses(const RunRequest& request, const Dataset& dataset,
                       std::span<const Event> events, const StartOptions& options) {
  const double from_s = seconds_from_ns(events.front().t_ns);
  const double whole_s = seconds_from_ns(events.back().t_ns) - from_s;
  const double truth_s = std::min(options.truth_s, options.truth_fraction * whole_s);
  if (truth_s < 0.99 * options.truth_s)
    show_notice(fmt::format(
        "start.truth_s of {:.3g} s is cut to {:.3g} s, of the events' time the part that "
        "start.truth_fraction allows ({:g})",
        options.truth_s, truth_s, options.truth_fraction));
  Trajectory start = given_start(request, dataset, from_s, from_s + truth_s, options.time_offset_s);
  if (start.size() < 2)
    throw InputError(
        request.poses_from.value_or(dataset.folder() / "groundtruth.txt").string(),
        fmt::format("holds fewer than two poses of the first {:.4g} s, which start.truth_s asks "
                    "for",
                    truth_s));
  return start;
}

/// Less parallax hardly tells a depth.
constexpr double kPoor_px = 4;

/// Says where the given poses move points at the scene's mean depth by so little that they hardly tell it.
void say_how_far(const Trajectory& start, const Dataset& dataset, const PinholeCamera& camera) {
  const std::optional<double> depth_m = dataset.facts().mean_depth_m;
  if (!depth_m) return;
  double moved_m = 0;
  for (const StampedPose& pose : start.poses())
    moved_m = std::max(moved_m, (pose.world_from_camera.translation() -
                                 start.poses().front().world_from_camera.translation())
                                    .norm());
  const double moved_px = camera.fx * moved_m / *depth_m;
  if (moved_px < kPoor_px)
    show_notice(fmt::format(
        "the given poses of the first {:.3g} s move the camera by {:.2g} px of the scene's mean "
        "depth alone: scale and direction may be wrong by some percent; give more of them "
        "(start.truth_s, start.truth_fraction), or begin where it moves (--start-s)",
        start.end_s() - start.start_s(), moved_px));
}

/// Why there is no start from events alone, if there is none.
std::optional<std::string> refusal_of(const Bootstrap& start, const Gyroscope& gyroscope) {
  switch (start.status) {
    case Bootstrap::Status::kFound:
      return std::nullopt;
    case Bootstrap::Status::kNoMotion:
      return "the events show no motion that odometry could start from";
    case Bootstrap::Status::kUnexplained:
      break;
  }
  return fmt::format(
      "no motion of the camera that was tried explains the events at the start: they show too few "
      "edges, or it shakes too fast or moves too little, for odometry to start without poses "
      "(start.truth_s){}",
      gyroscope.is_empty() ? " or a gyroscope (tracking.prediction: imu)" : "");
}

/// Why a start that was found is none, if it did not pass its trial.
std::optional<std::string> refusal_of(const StartTrial& trial, const Bootstrap& start) {
  const double at_s = start.path.start_s();
  switch (trial.outcome) {
    case StartTrial::Outcome::kPassed:
      return std::nullopt;
    case StartTrial::Outcome::kNoMap:
      return fmt::format("the path that was found from events alone at {:.3f} s makes no map",
                         at_s);
    case StartTrial::Outcome::kNoPose:
      return fmt::format(
          "no pose follows the start that was found at {:.3f} s, so that nothing tells whether it "
          "is right",
          at_s);
    case StartTrial::Outcome::kUnexplained:
      break;
  }
  return fmt::format(
      "the start that was found at {:.3f} s does not explain the events after it (probability "
      "{:.2f})",
      at_s, trial.probability);
}

/// What is known at the start, and how it came to be known.
struct Start {
  PathEstimate path;
  std::optional<Bootstrap> found;  ///< from events alone
  double from_s = 0;               ///< what is scored begins there
  double seconds = 0;              ///< of work
};

Start given_start_of(const RunRequest& request, const Dataset& dataset, const PinholeCamera& camera,
                     std::span<const Event> events, const StartOptions& options) {
  Start start;
  start.path.poses = start_poses(request, dataset, events, options);
  say_how_far(start.path.poses, dataset, camera);
  start.from_s = start.path.poses.end_s();
  start.path.fixed_until_s = start.path.given_until_s = start.from_s;
  return start;
}

Start start_of(Bootstrap found, double depth_m) {
  if (found.parallax_px < kPoor_px)
    show_notice(fmt::format(
        "the start shows {:.2g} px of parallax alone: its directions of motion are hardly known, "
        "and most depths may be assumed",
        found.parallax_px));
  Start start;
  start.from_s = found.path.start_s();
  // All but the first pose may change.
  start.path.poses = found.path;
  start.path.fixed_until_s = start.from_s;
  start.path.typical_depth_m = depth_m;
  start.found = std::move(found);
  return start;
}

/// What a run works on.
struct OdometryInput {
  Dataset dataset;
  PinholeCamera camera;
  Events events;
  Gyroscope gyroscope;
  std::optional<MountedImu> imu;
};

OdometryInput load(const RunRequest& request, const OdometryConfig& config) {
  Dataset dataset = Dataset::open(request.dataset);
  const PinholeCamera camera = config.camera.of(dataset.camera());
  OdometryInput input{std::move(dataset), camera, {}, {}, {}};
  input.events = load_events(request, input.dataset);
  input.gyroscope = load_gyroscope(config.odometry.tracker.motion, input.dataset);
  if (config.align_imu || config.odometry.batch_adjustment == BatchMode::kEventsAndImu)
    input.imu = load_mounted_imu(input.dataset, "align_imu or batch_adjustment");
  return input;
}

/// What a run found.
struct OdometryFound {
  OdometryResult result;
  std::vector<Keyframe> keyframes;
  double images_s = 0;
  bool is_metric = false;  ///< brought into metres and upright
};

/// The stages that are timed, as often as asked for; `wall_s` of each time.
OdometryFound run_stages(const OdometryInput& input, const Start& start,
                         const OdometryConfig& config, int repeat, PathSoFar& so_far,
                         std::vector<double>& wall_s) {
  OdometryFound found;
  so_far.show(start.path.poses.poses());
  std::optional<Odometry> odometry;
  Progress progress("odometry", input.events.size() * static_cast<std::size_t>(repeat), "events");
  for (int i = 0; i < repeat; ++i) {
    odometry.emplace(config.odometry, input.camera, config.seed);
    odometry->set_gyroscope(input.gyroscope);
    if (input.imu) odometry->set_imu(*input.imu);
    wall_s.push_back(start.seconds);
    const ScopedTimer clock(wall_s.back());
    found.result = odometry->run(input.events, start.path, [&](std::size_t n) {
      progress.add(n);
      so_far.show(odometry->path());
    });
    if (!found.result.trial.is_passed()) return found;
    if (!odometry->wants_batch_adjustment()) continue;
    Progress steps("batch", BatchAdjustmentOptions().steps(), "steps");
    odometry->adjust(input.events, start.path, found.result, [&](std::size_t n) { steps.add(n); });
  }
  if (config.odometry.mapping.image) {
    const ScopedTimer clock(found.images_s);
    Progress images("images", odometry->map().keyframes().size(), "keyframes");
    odometry->add_images(input.events, [&](std::size_t n) { images.add(n); });
  }
  found.keyframes = odometry->map().keyframes();
  return found;
}

/// A start and what follows from it.
struct Attempt {
  Start start;
  OdometryFound found;
};

/// So many starts are tried: two in three that are found pass, and those of a shaken camera take up
/// to a minute each.
constexpr int kMostStarts = 5;

/// The first start from events alone that passes its trial, with the run that followed. Throws
/// InputError where there is none, with what was wrong with the first.
Attempt first_that_passes(const OdometryInput& input, const OdometryConfig& config, int repeat,
                          PathSoFar& so_far, std::vector<double>& wall_s) {
  const std::span<const Event> events = input.events;
  const double end_s = seconds_from_ns(events.back().t_ns);
  double from_s = seconds_from_ns(events.front().t_ns), retry_s = kStartRetry_s;
  double seconds = 0;  // of work
  std::string first_refusal, last_refusal;
  for (int i = 0; i < kMostStarts && from_s < end_s; ++i) {
    if (i > 0) show_notice(last_refusal + ": another start is looked for");
    const std::size_t passed_over = i == 0 ? 0 : count_before(events, ns_from_seconds(from_s));
    Bootstrap found;
    {
      const ScopedTimer clock(seconds);
      found = find_start(events.subspan(passed_over), input.camera, config.start.found,
                         input.gyroscope);
    }
    if (const auto refusal = refusal_of(found, input.gyroscope)) {
      if (i == 0) throw InputError(input.dataset.folder().string(), *refusal);
      break;
    }
    // After a start that was wrong none is believed that has no trial.
    if (i > 0 && found.path.end_s() + kStartTrial_s / 2 > end_s) break;
    Attempt attempt{start_of(found, config.start.found.depth_m), {}};
    attempt.start.seconds = seconds;
    std::vector<double> spent_s;  // with the seconds before
    attempt.found = run_stages(input, attempt.start, config, repeat, so_far, spent_s);
    const auto refusal = refusal_of(attempt.found.result.trial, found);
    if (!refusal) {
      wall_s = std::move(spent_s);
      return attempt;
    }
    if (i == 0) first_refusal = *refusal;
    last_refusal = *refusal;
    seconds = spent_s.back();
    from_s = found.path.start_s() + retry_s;
    retry_s *= kStartRetryGrowth;
  }
  throw InputError(input.dataset.folder().string(),
                   first_refusal + ": begin elsewhere (--start-s), or give poses (start.truth_s)");
}

Attempt attempt_of(const RunRequest& request, const OdometryInput& input,
                   const OdometryConfig& config, PathSoFar& so_far, std::vector<double>& wall_s) {
  if (config.start.truth_s > 0) {
    Attempt attempt;
    attempt.start =
        given_start_of(request, input.dataset, input.camera, input.events, config.start);
    attempt.found = run_stages(input, attempt.start, config, request.repeat, so_far, wall_s);
    return attempt;
  }
  if (request.poses_from)
    throw InputError("--poses-from", "gives the poses of the start, and start.truth_s is 0");
  refuse_smoothing(request, "it is of the poses of the start, and start.truth_s is 0");
  return first_that_passes(input, config, request.repeat, so_far, wall_s);
}

/// Scale and gravity by the samples. Given poses have a world and metres of their own.
void align(OdometryFound& found, const OdometryInput& input, bool has_given_poses) {
  OdometryResult& result = found.result;
  result.inertial = align_odometry(result.poses, found.keyframes, *input.imu);
  found.is_metric = !has_given_poses && result.inertial->status == InertialAlignment::Status::kOk;
  if (found.is_metric)
    transform_to_metric_world(*result.inertial, result.poses, found.keyframes, result.covariances);
}

void write(const std::filesystem::path& folder, const OdometryInput& input, const Start& start,
           const OdometryConfig& config, const OdometryFound& found) {
  const OdometryResult& result = found.result;
  write_odometry(folder, input.camera, result, found.keyframes);
  if (!result.covariances.empty()) write_covariances(folder / "covariance.txt", result.covariances);
  if (result.inertial)
    write_inertial_alignment(folder / "inertial.yaml", *result.inertial, found.is_metric);
  if (start.found) write_start(folder / "start.yaml", *start.found, config.start.found.depth_m);
}

void take_timing(const OdometryFound& found, const Start& start, bool is_online,
                 RunTiming& timing) {
  const OdometryResult& result = found.result;
  timing.stages_s = {{"start", start.seconds},       {"tracking", result.tracking_s},
                     {"mapping", result.mapping_s},  {"check", result.check_s},
                     {"refinement", result.batch_s}, {"images", found.images_s}};
  timing.poses = result.poses.size();
  timing.latency_ms = result.latency_ms;
  if (is_online) timing.dropped_events = result.dropped_events;
}

/// A keyframe that is adjusted revises the poses of its window.
MethodClass class_of(const OdometryInput& input, const OdometryConfig& config) {
  MethodClass method{{MethodInput::kEvents}};
  if (config.start.truth_s > 0) method.inputs.insert(MethodInput::kStart);
  if (!input.gyroscope.is_empty() || input.imu) method.inputs.insert(MethodInput::kImu);
  const OdometryOptions& options = config.odometry;
  if (options.mapping.adjust_rounds > 0 || options.mapping.smoothing_s > 0)
    method.processing = Processing::kFixedLag;
  if (options.batch_adjustment != BatchMode::kNone && options.mode == OdometryMode::kOffline)
    method.processing = Processing::kBatch;
  return method;
}

RunSummary summary_of(const OdometryFound& found, const OdometryConfig& config,
                      const RunTiming& timing) {
  const std::size_t lost = count_lost(found.result.poses);
  std::string text = fmt::format("{} poses ({} lost) by {} keyframes", found.result.poses.size(),
                                 lost, found.keyframes.size());
  if (const double extrapolated_s = found.result.extrapolated_s; extrapolated_s > 0)
    text += fmt::format(", the start extrapolated for {:.2f} s", extrapolated_s);
  if (found.result.is_scale_guessed)
    text += ", the scale a guess: the given poses tell hardly any depth";
  if (config.odometry.batch_adjustment != BatchMode::kNone && lost > 0)
    text += ", not adjusted as a whole";
  if (const auto& inertial = found.result.inertial)
    text += fmt::format(", scale {:.4g} +- {:.2g} %", inertial->scale, 100 * inertial->scale_sigma);
  if (found.images_s > 0)
    text += fmt::format("; besides, its images took {:.1f} s (mapping.image)", found.images_s);
  RunSummary summary = summary_of(timing, text);
  summary.lost_poses = lost;
  summary.lost_since_s = lost_since_s(found.result.poses);
  return summary;
}

}  // namespace

RunSummary run_odometry(const RunRequest& request) {
  OdometryConfig config = config::read<OdometryConfig>(request.config);
  if (request.seed) config.seed = *request.seed;
  return run_odometry(request, config);
}

RunSummary run_odometry(const RunRequest& request, const OdometryConfig& config) {
  check(request);
  RunWriter writer(request);

  RunTiming timing;
  std::optional<ScopedTimer> io(timing.io_s);
  const OdometryInput input = load(request, config);
  io.reset();
  const Events& events = input.events;
  // What is scored begins where the given poses end, or where those that were found begin.
  RunRecord::Window window =
      window_of(request, seconds_from_ns(events.front().t_ns), seconds_from_ns(events.back().t_ns));
  timing.events = events.size();
  timing.sequence_s = seconds_from_ns(events.back().t_ns - events.front().t_ns);

  PathSoFar so_far(writer.path(), request.dataset);
  Attempt attempt = attempt_of(request, input, config, so_far, timing.wall_s);
  const Start& start = attempt.start;
  OdometryFound& found = attempt.found;
  window.start_s = start.from_s;
  if (config.align_imu) align(found, input, !start.found);
  report_gaps(events.back().t_ns, found.result.poses);
  take_timing(found, start, config.odometry.mode == OdometryMode::kOnline, timing);

  io.emplace(timing.io_s);
  write(writer.path(), input, start, config, found);
  io.reset();
  writer.set_class(class_of(input, config));
  writer.finish("odometry", request, input.dataset, window, config.seed, config::print(config),
                timing);
  return summary_of(found, config, timing);
}

}  // namespace saccade
