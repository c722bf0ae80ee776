#include "estimator/tracking/track_module.h"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <vector>

#include "core/config/config.h"
#include "core/error.h"
#include "core/median.h"
#include "core/process/progress.h"
#include "estimator/run/run_input.h"
#include "estimator/run/run_writer.h"
#include "estimator/tracking/frame_tracker.h"
#include "estimator/tracking/grey_frames.h"
#include "estimator/tracking/gyroscope_input.h"
#include "estimator/tracking/intensity_map.h"
#include "estimator/tracking/intensity_tracker.h"
#include "estimator/tracking/pose_output.h"
#include "estimator/tracking/reference_view.h"
#include "estimator/tracking/track_config.h"

namespace saccade {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Everything that tracking needs, read from the dataset.
struct TrackInput {
  PinholeCamera camera;
  Events events;                  ///< none where frames are tracked
  std::vector<GreyFrame> frames;  ///< none where events are
  RunRecord::Window window;
  std::vector<ReferenceView> references;
  Rigid3 initial_world_from_camera;
  Gyroscope gyroscope;  ///< empty unless it is needed
};

/// `measurements`: events or frames, at least one.
template <class Measurements>
RunRecord::Window window_over(const RunRequest& request, const Measurements& measurements) {
  return window_of(request, seconds_from_ns(measurements.front().t_ns),
                   seconds_from_ns(measurements.back().t_ns));
}

Rigid3 initial_pose(const TrackConfig& config, const Dataset& dataset, double start_s) {
  if (config.initial_pose) {
    const auto& p = *config.initial_pose;
    const Eigen::Quaterniond q(p[6], p[3], p[4], p[5]);
    if (std::abs(q.norm() - 1) > 1e-3)
      throw InputError("initial_pose",
                       fmt::format("the quaternion has length {}, not 1", q.norm()));
    return {q, {p[0], p[1], p[2]}};
  }
  if (dataset.groundtruth().empty())
    throw InputError(dataset.folder().string(),
                     "holds no groundtruth.txt to start from; state initial_pose");
  return dataset.groundtruth().at_clamped(start_s);
}

std::vector<GreyFrame> load_frame_window(const RunRequest& request, const Dataset& dataset,
                                         const PinholeCamera& camera) {
  const double infinity = std::numeric_limits<double>::infinity();
  const double first_s = dataset.frames().empty() ? 0 : dataset.frames().front().t_s;
  const double start_s = request.start_s.value_or(first_s);
  return load_grey_frames(dataset, camera, start_s,
                          request.duration_s ? start_s + *request.duration_s : infinity);
}

TrackInput load_input(const RunRequest& request, const TrackConfig& config,
                      const Dataset& dataset) {
  TrackInput input;
  input.camera = config.camera.of(dataset.camera());
  if (config.method == TrackConfig::Method::kFrames) {
    input.frames = load_frame_window(request, dataset, input.camera);
    input.window = window_over(request, input.frames);
  } else {
    input.events = load_events(request, dataset);
    input.window = window_over(request, input.events);
  }
  input.references = load_references(dataset, input.camera, config.reference, input.window.start_s,
                                     input.window.end_s);
  input.initial_world_from_camera = initial_pose(config, dataset, input.window.start_s);
  input.gyroscope = load_gyroscope(config.tracker.motion, dataset);
  return input;
}

struct TrackOutput {
  MapPoints map;
  std::vector<TrackedPose> poses;
  RunTiming timing;
};

/// The map points of all views, in the frame of the first.
MapPoints map_of(const TrackConfig& config, const PinholeCamera& camera,
                 const std::vector<ReferenceView>& views) {
  MapPoints all;
  const Rigid3 map_from_world = views.front().world_from_reference.inverse();
  for (const ReferenceView& view : views) {
    const MapPoints points = extract_map(view.log_intensity, view.depth, camera, config.map);
    const Rigid3 map_from_view = map_from_world * view.world_from_reference;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Eigen::Vector3d point =
          map_from_view * Eigen::Vector3d(points.x[i], points.y[i], points.z[i]);
      all.x.push_back(static_cast<float>(point.x()));
      all.y.push_back(static_cast<float>(point.y()));
      all.z.push_back(static_cast<float>(point.z()));
    }
  }
  return all;
}

EventContrast contrast_of(const TrackConfig& config, const Dataset& dataset) {
  if (config.contrast) return {*config.contrast, *config.contrast};
  const DatasetFacts& facts = dataset.facts();
  if (!facts.contrast_on || !facts.contrast_off)
    throw InputError(dataset.folder().string(),
                     "does not state its contrast thresholds; state intensity.contrast");
  return {*facts.contrast_on, *facts.contrast_off};
}

/// Any tracker over all of its measurements, events or frames, `repeat` times.
template <class AnyTracker, class Measurements>
void track_repeatedly(AnyTracker& tracker, const Measurements& measurements, const char* unit,
                      const Rigid3& initial_world_from_camera, int repeat, TrackOutput& output) {
  Progress progress("track", measurements.size() * static_cast<std::size_t>(repeat), unit);
  for (int i = 0; i < repeat; ++i) {
    tracker.reset(measurements.front().t_ns, initial_world_from_camera);
    const auto start = Clock::now();
    output.poses = tracker.track(measurements, [&](std::size_t n) { progress.add(n); });
    output.timing.wall_s.push_back(seconds_since(start));
  }
  const TrackTiming& stages = tracker.timing();
  output.timing.stages_s.insert(output.timing.stages_s.end(),
                                {{"template", stages.template_s},
                                 {"event_frame", stages.event_frame_s},
                                 {"align", stages.align_s}});
}

/// How the map's picture is smoothed for the method.
const IntensityMapOptions& smoothing_of(const TrackConfig& config) {
  if (config.method == TrackConfig::Method::kFrames) return config.frames_map;
  if (config.method == TrackConfig::Method::kPolarity) return config.polarity.map;
  return config.intensity.map;
}

TrackOutput track(const TrackConfig& config, const Dataset& dataset, const TrackInput& input,
                  int repeat) {
  const PinholeCamera& camera = input.camera;
  const Rigid3& start = input.initial_world_from_camera;
  TrackOutput output;
  const auto map_start = Clock::now();
  output.map = map_of(config, camera.undistorted(), input.references);
  const IntensityMap map(camera.undistorted(), input.references, smoothing_of(config));
  output.timing.stages_s = {{"map", seconds_since(map_start)}};
  Tracker edges(config.tracker, camera, output.map, map.world_from_map(), config.seed);
  edges.set_gyroscope(input.gyroscope);
  if (config.method == TrackConfig::Method::kIntensity) {
    IntensityTracker tracker(config.intensity, config.tracker.motion, contrast_of(config, dataset),
                             camera, map, edges);
    tracker.set_gyroscope(input.gyroscope);
    track_repeatedly(tracker, input.events, "events", start, repeat, output);
  } else if (config.method == TrackConfig::Method::kPolarity) {
    PolarityTracker tracker(config.polarity, config.tracker.motion, camera, map, edges);
    tracker.set_gyroscope(input.gyroscope);
    track_repeatedly(tracker, input.events, "events", start, repeat, output);
  } else if (config.method == TrackConfig::Method::kFrames) {
    FrameTracker tracker(config.frames, config.tracker.motion, map);
    track_repeatedly(tracker, input.frames, "frames", start, repeat, output);
  } else {
    track_repeatedly(edges, input.events, "events", start, repeat, output);
  }
  output.timing.events = input.events.size();
  output.timing.poses = output.poses.size();
  output.timing.sequence_s = input.window.end_s - input.window.start_s;
  return output;
}

}  // namespace

RunSummary run_track(const RunRequest& request) {
  const auto config = read_config<TrackConfig>(request);
  RunWriter writer(request);

  const auto read_start = Clock::now();
  const Dataset dataset = Dataset::open(request.dataset);
  const TrackInput input = load_input(request, config, dataset);
  const double read_s = seconds_since(read_start);

  TrackOutput output = track(config, dataset, input, request.repeat);

  const auto write_start = Clock::now();
  write_poses(writer.path(), output.poses);
  write_map(writer.path() / "map.ply", output.map, input.references.front().world_from_reference);
  output.timing.io_s = read_s + seconds_since(write_start);
  writer.finish("track", request, dataset, input.window, config.seed, config::print(config),
                output.timing);

  RunSummary summary;
  summary.events = input.events.size();
  summary.poses = output.poses.size();
  summary.lost_poses = count_lost(output.poses);
  summary.found = fmt::format("{} poses ({} lost)", summary.poses, summary.lost_poses);
  summary.wall_s = median(output.timing.wall_s);
  return summary;
}

std::string print_track_config(const config::Document& document) {
  return config::print_documented(config::read<TrackConfig>(document));
}

}  // namespace saccade
