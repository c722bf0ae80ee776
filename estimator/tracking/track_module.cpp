#include "estimator/tracking/track_module.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/config/config.h"
#include "core/io/events/event_file.h"
#include "core/io/events/event_queue.h"
#include "core/process/progress.h"
#include "core/stopwatch.h"
#include "estimator/run/run_input.h"
#include "estimator/run/run_writer.h"
#include "estimator/tracking/check/pose_monitor.h"
#include "estimator/tracking/edges/tracking_figures.h"
#include "estimator/tracking/frames/grey_frames.h"
#include "estimator/tracking/pose_output.h"
#include "estimator/tracking/track_config.h"
#include "estimator/tracking/track_start.h"
#include "estimator/tracking/tracker_feed.h"

namespace saccade {
namespace {

/// Everything that tracking needs, read from the dataset.
struct TrackInput {
  std::optional<EventQueue> events;  ///< none where frames are tracked
  std::vector<GreyFrame> frames;     ///< none where events are
  TimeNs start_ns = 0;               ///< of the first of them
  TrackStart start;
};

EventQueue open_events(const RunRequest& request, const Dataset& dataset) {
  EventQueue events(dataset.stream_events(event_window(request, dataset)));
  if (events.ahead(1).empty()) refuse_no_events(dataset);
  return events;
}

std::vector<GreyFrame> load_frame_window(const RunRequest& request, const Dataset& dataset,
                                         const PinholeCamera& camera) {
  const double infinity = std::numeric_limits<double>::infinity();
  const double first_s = dataset.frames().empty() ? 0 : dataset.frames().front().t_s;
  const double start_s = request.start_s.value_or(first_s);
  return load_grey_frames(dataset, camera, start_s,
                          request.duration_s ? start_s + *request.duration_s : infinity);
}

/// Time of the last measurement [s], by which further views of the map are chosen. Infinity where
/// there are none to choose: some files of events tell their end only when all of it has been read.
double last_s_of(const TrackConfig& config, const Dataset& dataset, const TrackInput& input) {
  if (!input.frames.empty()) return seconds_from_ns(input.frames.back().t_ns);
  if (!config.reference.new_view_deg) return std::numeric_limits<double>::infinity();
  return seconds_from_ns(read_event_file_info(dataset.events_file()).last_ns);
}

/// The measurements of the window, and what tracking starts from.
TrackInput load_input(const RunRequest& request, const TrackConfig& config,
                      const Dataset& dataset) {
  TrackInput input;
  if (method_of(config).takes_frames) {
    input.frames = load_frame_window(request, dataset, config.camera.of(dataset.camera()));
    input.start_ns = input.frames.front().t_ns;
  } else {
    input.events = open_events(request, dataset);
    input.start_ns = input.events->ahead(1).front().t_ns;
  }
  const RunRecord::Window window =
      window_of(request, seconds_from_ns(input.start_ns), last_s_of(config, dataset, input));
  input.start = load_track_start(config, dataset, window.start_s, window.end_s);
  return input;
}

/// What a tracker made of a recording.
struct Tracked {
  std::vector<TrackedPose> poses;
  std::size_t measurements = 0;
  TimeNs end_ns = 0;    ///< of the last measurement
  double check_s = 0;   ///< time that went into judging the poses
  double waited_s = 0;  ///< for events to be read and handed over
};

/// Of measurements that are tracked all at once.
Tracked track_at_once(Tracker& tracker, const TrackInput& input, const TrackWorld& world,
                      const Recording& recording, Progress& progress) {
  Tracked tracked;
  tracker.reset(input.start_ns, input.start.world_from_camera);
  tracked.poses = tracker.track(recording, [&](std::size_t n) { progress.add(n); });
  const ScopedTimer clock(tracked.check_s);
  judge_poses(input.start.camera, recording, world.edge_points,
              world.intensity_map.world_from_map(), tracked.poses);
  return tracked;
}

Tracked track_frames(Tracker& tracker, const TrackInput& input, const TrackWorld& world,
                     Progress& progress) {
  Tracked tracked = track_at_once(tracker, input, world, {.frames = input.frames}, progress);
  tracked.measurements = input.frames.size();
  tracked.end_ns = input.frames.back().t_ns;
  return tracked;
}

/// All that is left in the queue, piece by piece where the method allows it.
Tracked track_events(Tracker& tracker, const TrackConfig& config, TrackInput& input,
                     const TrackWorld& world, Progress& progress) {
  EventQueue& queue = *input.events;
  const double waited_before_s = queue.waited_s();
  Tracked tracked;
  if (!is_fed_in_pieces(config)) {
    const std::span<const Event> all = queue.ahead(std::numeric_limits<std::size_t>::max());
    tracked = track_at_once(tracker, input, world, {.events = all}, progress);
    tracked.measurements = all.size();
    tracked.end_ns = all.back().t_ns;
  } else {
    TrackerFeed feed(tracker, world, input.start.world_from_camera);
    const auto append = [&](const std::vector<TrackedPose>& poses) {
      tracked.poses.insert(tracked.poses.end(), poses.begin(), poses.end());
    };
    for (auto events = queue.ahead(1); !events.empty(); events = queue.ahead(1)) {
      const std::size_t count = events.size();
      tracked.measurements += count;
      tracked.end_ns = events.back().t_ns;
      {
        const ScopedTimer moving(tracked.waited_s);
        std::copy(events.begin(), events.end(), feed.room(count).begin());
        queue.drop(count);
      }
      append(feed.feed());
      progress.add(count);
    }
    append(feed.finish());
    tracked.check_s = feed.check_s();
  }
  tracked.waited_s += queue.waited_s() - waited_before_s;
  return tracked;
}

/// The tracker over the whole recording, its poses judged, `repeat` times.
Tracked track(Tracker& tracker, const RunRequest& request, const TrackConfig& config,
              const Dataset& dataset, TrackInput& input, const TrackWorld& world,
              RunTiming& timing) {
  const bool has_frames = !input.events;
  const std::size_t expected =
      has_frames ? input.frames.size() : static_cast<std::size_t>(input.events->expected_count());
  Progress progress("track", expected * static_cast<std::size_t>(request.repeat),
                    has_frames ? "frames" : "events");
  Tracked tracked;
  for (int i = 0; i < request.repeat; ++i) {
    if (i > 0 && !has_frames) input.events = open_events(request, dataset);
    const Stopwatch clock;
    tracked = has_frames ? track_frames(tracker, input, world, progress)
                         : track_events(tracker, config, input, world, progress);
    report_gaps(tracked.end_ns, tracked.poses);
    timing.wall_s.push_back(clock.seconds() - tracked.waited_s);
  }
  timing.stages_s.insert(timing.stages_s.end(), {{"template", tracker.timing().view_s},
                                                 {"event_frame", tracker.timing().load_s},
                                                 {"align", tracker.timing().align_s},
                                                 {"check", tracked.check_s}});
  timing.io_s += tracked.waited_s;
  timing.events = has_frames ? 0 : tracked.measurements;
  timing.poses =
      static_cast<std::size_t>(std::count_if(tracked.poses.begin(), tracked.poses.end(),
                                             [](const TrackedPose& pose) { return !pose.is_gap; }));
  return tracked;
}

/// Of the pose in the middle of the run; nothing where there is none.
void write_figures(const std::filesystem::path& folder, const TrackConfig& config,
                   const Dataset& dataset, const TrackInput& input, const TrackWorld& world,
                   std::span<const TrackedPose> poses) {
  const TrackedPose* moment = nullptr;
  for (std::size_t i = 0; i < poses.size() && (!moment || i <= poses.size() / 2); ++i)
    if (!poses[i].is_gap) moment = &poses[i];
  if (!moment) return;
  const Events events = dataset.load_events(TimeWindow{moment->first_ns, moment->last_ns + 1});
  const ReferenceView& reference = input.start.references.front();
  write_tracking_figures(
      folder, config.edges, input.start.camera, reference, world.edge_points,
      {events, reference.world_from_reference.inverse() * moment->world_from_camera});
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
  TrackInput input = load_input(request, config, dataset);
  timing.io_s = reading.seconds();

  const Stopwatch mapping;
  const TrackWorld world = world_of(config, input.start);
  timing.stages_s = {{"map", mapping.seconds()}};
  const std::unique_ptr<Tracker> tracker = method_of(config).make(config, world);
  const Tracked tracked = track(*tracker, request, config, dataset, input, world, timing);
  const std::vector<TrackedPose>& poses = tracked.poses;
  const RunRecord::Window window =
      window_of(request, seconds_from_ns(input.start_ns), seconds_from_ns(tracked.end_ns));
  timing.sequence_s = window.end_s - window.start_s;

  {
    const ScopedTimer writing(timing.io_s);
    write_poses(writer.path(), poses);
    write_map(writer.path() / "map.ply", world.edge_points, world.intensity_map.world_from_map());
    if (config.figures) write_figures(writer.path(), config, dataset, input, world, poses);
  }
  writer.set_class(class_of(config, input));
  const std::optional<EventContrast> contrast = tracker->found_contrast();
  if (contrast) writer.set_contrast({contrast->on, contrast->off});
  writer.finish("track", request, dataset, window, config.seed, config::print(config), timing);

  const std::size_t lost = count_lost(poses);
  std::string found = fmt::format("{} poses ({} lost)", poses.size(), lost);
  if (contrast)
    found += fmt::format(", contrast thresholds {:.2f} (ON) and {:.2f} (OFF) found", contrast->on,
                         contrast->off);
  RunSummary summary = summary_of(timing, found);
  summary.lost_poses = lost;
  summary.lost_since_s = poses.empty() ? std::optional(window.start_s) : lost_since_s(poses);
  return summary;
}

}  // namespace saccade
