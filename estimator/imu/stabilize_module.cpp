#include "estimator/imu/stabilize_module.h"

#include <fmt/core.h>

#include <optional>
#include <vector>

#include "core/config/config.h"
#include "core/error.h"
#include "core/io/imu_file.h"
#include "core/io/trajectory_file.h"
#include "core/process/parallel.h"
#include "core/process/progress.h"
#include "core/stopwatch.h"
#include "core/time_search.h"
#include "estimator/imu/imu_input.h"
#include "estimator/imu/stabilize_output.h"
#include "estimator/imu/stabilizer.h"
#include "estimator/run/run_input.h"
#include "estimator/run/run_writer.h"

namespace saccade {
namespace {

/// Consecutive windows of `window_s` from the first event on; empty ones are left out.
std::vector<std::span<const Event>> event_windows(std::span<const Event> events, double window_s) {
  std::vector<std::span<const Event>> windows;
  const TimeNs window_ns = ns_from_seconds(window_s);
  while (!events.empty()) {
    const TimeNs start_ns = windows.empty() ? events.front().t_ns : windows.front().front().t_ns;
    const TimeNs begin_ns = start_ns + (events.front().t_ns - start_ns) / window_ns * window_ns;
    windows.push_back(events.first(count_before(events, begin_ns + window_ns)));
    events = events.subspan(windows.back().size());
  }
  return windows;
}

/// The time of a window of events and, in its middle, the rotation to the smoothed orientation.
StabilizedWindow window_at(TimeNs begin_ns, TimeNs length_ns, const Trajectory& world_from_camera,
                           const Trajectory& world_from_smoothed) {
  StabilizedWindow window;
  window.start_s = seconds_from_ns(begin_ns);
  window.end_s = seconds_from_ns(begin_ns + length_ns);
  window.at_s = seconds_from_ns(begin_ns + length_ns / 2);
  window.steady_from_camera = world_from_smoothed.at_clamped(window.at_s).rotation().conjugate() *
                              world_from_camera.at_clamped(window.at_s).rotation();
  return window;
}

/// Result of one repetition.
struct Stabilization {
  ImuPoses camera;  ///< without an inertial sensor its biases are empty
  Trajectory world_from_smoothed;
  std::vector<StabilizedWindow> windows;
  std::vector<std::vector<StabilizedEvent>> events;  ///< of each window
};

Stabilization stabilize(const std::optional<ImuInput>& imu, const Trajectory& given_poses,
                        std::span<const Event> events, const StabilizeConfig& config,
                        const PinholeCamera& camera, RunTiming& timing) {
  Stabilization result;
  double orientation_s = 0, events_s = 0;
  {
    const ScopedTimer clock(orientation_s);
    result.camera = imu ? camera_orientations(*imu, config.orientation) : ImuPoses{given_poses, {}};
    result.world_from_smoothed =
        smoothed_orientations(result.camera.world_from_camera, config.smoothing);
  }
  {
    const ScopedTimer clock(events_s);
    const Stabilizer stabilizer(camera, result.camera.world_from_camera);
    const auto windows = event_windows(events, config.window_s);
    const TimeNs length_ns = ns_from_seconds(config.window_s);
    result.windows.resize(windows.size());
    result.events.resize(windows.size());
    parallel_for(windows.size(), [&](std::size_t i) {
      const TimeNs start_ns = events.front().t_ns;
      const TimeNs index = (windows[i].front().t_ns - start_ns) / length_ns;
      result.windows[i] = window_at(start_ns + index * length_ns, length_ns,
                                    result.camera.world_from_camera, result.world_from_smoothed);
      const Rigid3 steady = result.world_from_smoothed.at_clamped(result.windows[i].at_s);
      result.events[i] = stabilizer.stabilize(windows[i], steady.rotation());
    });
  }
  timing.wall_s.push_back(orientation_s + events_s);
  timing.stages_s = {{"orientation", orientation_s}, {"events", events_s}};
  return result;
}

void write(const std::filesystem::path& folder, const Dataset& dataset, const Stabilization& result,
           const RunRecord::Window& window) {
  write_orientations(folder / "orientation.txt", result.camera.world_from_camera.poses());
  if (!result.camera.gyro.empty()) write_gyro_biases(folder / "gyro_bias.txt", result.camera.gyro);
  if (!result.windows.empty())
    write_stabilized_events(folder / "stabilized", dataset.camera(), result.windows, result.events);
  write_stabilized_frames(folder / "stabilized", dataset, window,
                          Stabilizer(dataset.camera(), result.camera.world_from_camera),
                          result.world_from_smoothed);
}

}  // namespace

void describe(config::Fields& fields, StabilizeConfig& config) {
  fields.section("orientation", config.orientation,
                 "Orientation from the inertial sensor. Not used with --poses-from.");
  fields
      .value("time_constant_s", config.smoothing.time_constant_s,
             "Time constant of the low-pass filter of the steady orientation, in seconds. Larger "
             "values remove slower motion; 0.4 corresponds to the thesis's 0.1 per frame (3.18).")
      .range(1e-4, 1e6);
  fields.value("lock_roll", config.smoothing.lock_roll,
               "Keeps the rows of the stabilized image horizontal.");
  fields.group(
      "window",
      [&](config::Fields& window) {
        window
            .value("duration_s", config.window_s,
                   "Duration of a window, in seconds. Shorter windows follow the steady "
                   "orientation more closely and hold fewer events.")
            .range(1e-4, 1e4);
      },
      "Part of the events that is rotated to one steady orientation.");
  fields.value("seed", config.seed,
               "Seed of the run. It changes nothing here: no random numbers are drawn.");
}

RunSummary run_stabilization(const RunRequest& request) {
  const auto config = read_config<StabilizeConfig>(request);
  RunWriter writer(request);

  RunTiming timing;
  const Dataset dataset = Dataset::open(request.dataset);
  std::optional<ImuInput> imu;
  Trajectory given_poses;
  Events events;
  {
    const ScopedTimer clock(timing.io_s);
    if (request.poses_from)
      given_poses = load_poses(request, dataset).trajectory;
    else
      imu = load_imu_input(dataset, "stabilize (or --poses-from RUN)");
    if (!dataset.events_file().empty()) events = load_events_if_any(request, dataset);
  }
  timing.events = events.size();
  Stabilization result;
  Progress progress("stabilize", timing.events * static_cast<std::size_t>(request.repeat),
                    "events");
  for (int i = 0; i < request.repeat; ++i) {
    result = stabilize(imu, given_poses, events, config, dataset.camera(), timing);
    progress.add(timing.events);
  }
  const Trajectory& poses = result.camera.world_from_camera;
  timing.sequence_s = poses.end_s() - poses.start_s();
  // --duration-s without --start-s counts from the first event, as it does when they are loaded.
  const bool is_from_events = request.duration_s && !events.empty();
  const double first_s = is_from_events ? seconds_from_ns(events.front().t_ns) : poses.start_s();
  const RunRecord::Window window = window_of(request, first_s, poses.end_s());
  {
    const ScopedTimer clock(timing.io_s);
    write(writer.path(), dataset, result, window);
  }
  MethodClass method_class{{MethodInput::kEvents}};
  if (imu) method_class.inputs.insert(MethodInput::kImu);
  writer.set_class(method_class);
  writer.finish("stabilize", request, dataset, window, config.seed, config::print(config), timing);

  return summary_of(timing, fmt::format("{} orientations, {} windows of events", poses.size(),
                                        result.windows.size()));
}

}  // namespace saccade
