#include "estimator/tracking/track_module.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "core/config/config.h"
#include "core/error.h"
#include "core/process/progress.h"
#include "core/stopwatch.h"
#include "estimator/run/repeat.h"
#include "estimator/run/run_input.h"
#include "estimator/run/run_writer.h"
#include "estimator/tracking/check/pose_monitor.h"
#include "estimator/tracking/edges/tracking_figures.h"
#include "estimator/tracking/frames/grey_frames.h"
#include "estimator/tracking/pose_output.h"
#include "estimator/tracking/track_config.h"
#include "estimator/tracking/track_start.h"

namespace saccade {
namespace {

/// Everything that tracking needs, read from the dataset.
struct TrackInput {
  Events events;                  ///< none where frames are tracked
  std::vector<GreyFrame> frames;  ///< none where events are
  RunRecord::Window window;
  TrackStart start;
};

/// `measurements`: events or frames, at least one.
template <class Measurements>
RunRecord::Window window_over(const RunRequest& request, const Measurements& measurements) {
  return window_of(request, seconds_from_ns(measurements.front().t_ns),
                   seconds_from_ns(measurements.back().t_ns));
}

std::vector<GreyFrame> load_frame_window(const RunRequest& request, const Dataset& dataset,
                                         const PinholeCamera& camera) {
  const double infinity = std::numeric_limits<double>::infinity();
  const double first_s = dataset.frames().empty() ? 0 : dataset.frames().front().t_s;
  const double start_s = request.start_s.value_or(first_s);
  return load_grey_frames(dataset, camera, start_s,
                          request.duration_s ? start_s + *request.duration_s : infinity);
}

/// The measurements of the window, and what tracking starts from.
TrackInput load_input(const RunRequest& request, const TrackConfig& config,
                      const Dataset& dataset) {
  TrackInput input;
  const PinholeCamera camera = config.camera.of(dataset.camera());
  if (method_of(config).takes_frames) {
    input.frames = load_frame_window(request, dataset, camera);
    input.window = window_over(request, input.frames);
  } else {
    input.events = load_events(request, dataset);
    input.window = window_over(request, input.events);
  }
  input.start = load_track_start(config, dataset, input.window.start_s, input.window.end_s);
  return input;
}

/// The tracker over the whole recording, its poses judged, `repeat` times.
std::vector<TrackedPose> track(Tracker& tracker, const TrackInput& input, const TrackWorld& world,
                               int repeat, RunTiming& timing) {
  const Recording recording{input.events, input.frames};
  const bool has_frames = !input.frames.empty();
  const std::size_t count = has_frames ? input.frames.size() : input.events.size();
  const TimeNs start_ns = has_frames ? input.frames.front().t_ns : input.events.front().t_ns;
  Progress progress("track", count * static_cast<std::size_t>(repeat),
                    has_frames ? "frames" : "events");
  const TimeNs end_ns = has_frames ? input.frames.back().t_ns : input.events.back().t_ns;
  std::vector<TrackedPose> poses;
  double check_s = 0;
  repeat_timed(repeat, timing.wall_s, [&] {
    tracker.reset(start_ns, input.start.world_from_camera);
    poses = tracker.track(recording, [&](std::size_t n) { progress.add(n); });
    check_s = 0;
    const ScopedTimer clock(check_s);
    judge_poses(input.start.camera, recording, world.edge_points,
                world.intensity_map.world_from_map(), poses);
    report_gaps(end_ns, poses);
  });
  timing.stages_s.insert(timing.stages_s.end(), {{"template", tracker.timing().view_s},
                                                 {"event_frame", tracker.timing().load_s},
                                                 {"align", tracker.timing().align_s},
                                                 {"check", check_s}});
  timing.events = input.events.size();
  timing.poses = static_cast<std::size_t>(
      std::count_if(poses.begin(), poses.end(), [](const TrackedPose& p) { return !p.is_gap; }));
  timing.sequence_s = input.window.end_s - input.window.start_s;
  return poses;
}

/// Of the pose in the middle of the run; nothing where there is none.
void write_figures(const std::filesystem::path& folder, const TrackConfig& config,
                   const TrackInput& input, const TrackWorld& world,
                   std::span<const TrackedPose> poses) {
  const TrackedPose* moment = nullptr;
  for (std::size_t i = 0; i < poses.size() && (!moment || i <= poses.size() / 2); ++i)
    if (!poses[i].is_gap) moment = &poses[i];
  if (!moment) return;
  const auto first = std::lower_bound(input.events.begin(), input.events.end(), moment->first_ns,
                                      [](const Event& e, TimeNs t_ns) { return e.t_ns < t_ns; });
  const auto last = std::upper_bound(first, input.events.end(), moment->last_ns,
                                     [](TimeNs t_ns, const Event& e) { return t_ns < e.t_ns; });
  const ReferenceView& reference = input.start.references.front();
  write_tracking_figures(
      folder, config.edges, input.start.camera, reference, world.edge_points,
      {{first, last}, reference.world_from_reference.inverse() * moment->world_from_camera});
}

MethodClass class_of(const TrackConfig& config, const TrackInput& input) {
  MethodClass method{{MethodInput::kMap}};
  method.inputs.insert(method_of(config).takes_frames ? MethodInput::kFrames
                                                      : MethodInput::kEvents);
  if (!input.start.gyroscope.is_empty()) method.inputs.insert(MethodInput::kImu);
  return method;
}

}  // namespace

RunSummary run_track(const RunRequest& request) {
  const auto config = read_config<TrackConfig>(request);
  RunWriter writer(request);

  RunTiming timing;
  const Stopwatch reading;
  const Dataset dataset = Dataset::open(request.dataset);
  const TrackInput input = load_input(request, config, dataset);
  timing.io_s = reading.seconds();

  const Stopwatch mapping;
  const TrackWorld world = world_of(config, input.start);
  timing.stages_s = {{"map", mapping.seconds()}};
  const std::unique_ptr<Tracker> tracker = method_of(config).make(config, world);
  const std::vector<TrackedPose> poses = track(*tracker, input, world, request.repeat, timing);

  {
    const ScopedTimer writing(timing.io_s);
    write_poses(writer.path(), poses);
    write_map(writer.path() / "map.ply", world.edge_points, world.intensity_map.world_from_map());
    if (config.figures) write_figures(writer.path(), config, input, world, poses);
  }
  writer.set_class(class_of(config, input));
  const std::optional<EventContrast> contrast = tracker->found_contrast();
  if (contrast) writer.set_contrast({contrast->on, contrast->off});
  writer.finish("track", request, dataset, input.window, config.seed, config::print(config),
                timing);

  const std::size_t lost = count_lost(poses);
  std::string found = fmt::format("{} poses ({} lost)", poses.size(), lost);
  if (contrast)
    found += fmt::format(", contrast thresholds {:.2f} (ON) and {:.2f} (OFF) found", contrast->on,
                         contrast->off);
  RunSummary summary = summary_of(timing, found);
  summary.lost_poses = lost;
  summary.lost_since_s = poses.empty() ? std::optional(input.window.start_s) : lost_since_s(poses);
  return summary;
}

}  // namespace saccade
