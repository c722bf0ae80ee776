#include "estimator/imu/stabilize_module.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/config/config.h"
#include "core/error.h"
#include "core/io/imu_file.h"
#include "core/io/trajectory_file.h"
#include "core/process/parallel.h"
#include "core/process/progress.h"
#include "core/stopwatch.h"
#include "estimator/imu/imu_input.h"
#include "estimator/imu/stabilize_config.h"
#include "estimator/imu/stabilize_output.h"
#include "estimator/imu/stabilizer.h"
#include "estimator/run/run_input.h"
#include "estimator/run/run_writer.h"

namespace saccade {
namespace {

/// Everything that stabilization starts from.
struct StabilizeInput {
  std::optional<ImuInput> imu;  ///< none where another run's poses are used
  Trajectory poses;             ///< those
  Events events;                ///< perhaps none
};

StabilizeInput load_input(const RunRequest& request, const Dataset& dataset) {
  StabilizeInput input;
  if (request.poses_from)
    input.poses = load_poses(request, dataset);
  else
    input.imu = load_imu_input(dataset, "stabilize (or --poses-from RUN)");
  if (!dataset.events_file().empty()) input.events = load_events_if_any(request, dataset);
  return input;
}

struct Stabilization {
  ImuPoses camera;  ///< without an inertial sensor its biases are empty
  Trajectory world_from_steady;
  std::vector<StabilizedStretch> stretches;
};

/// Consecutive stretches of `window_s` from the first event on; those without events are left out.
std::vector<StabilizedStretch> cut(std::span<const Event> events, double window_s) {
  std::vector<StabilizedStretch> stretches;
  if (events.empty()) return stretches;
  const TimeNs window_ns = ns_from_seconds(window_s);
  const TimeNs start_ns = events.front().t_ns;
  while (!events.empty()) {
    const TimeNs begin_ns = start_ns + (events.front().t_ns - start_ns) / window_ns * window_ns;
    const TimeNs end_ns = begin_ns + window_ns;
    const auto end = std::partition_point(events.begin(), events.end(),
                                          [end_ns](const Event& e) { return e.t_ns < end_ns; });
    const auto count = static_cast<std::size_t>(end - events.begin());
    StabilizedStretch stretch;
    stretch.window.start_s = seconds_from_ns(begin_ns);
    stretch.window.end_s = seconds_from_ns(end_ns);
    stretch.window.at_s = seconds_from_ns(begin_ns + window_ns / 2);
    stretch.events = events.first(count);
    stretches.push_back(std::move(stretch));
    events = events.subspan(count);
  }
  return stretches;
}

void stabilize(const StabilizeInput& input, const StabilizeConfig& config,
               const PinholeCamera& camera, Stabilization& result, RunTiming& timing) {
  double orientation_s = 0, events_s = 0;
  {
    const ScopedTimer clock(orientation_s);
    result.camera =
        input.imu ? camera_orientations(*input.imu, config.orientation) : ImuPoses{input.poses, {}};
    result.world_from_steady = steady_poses(result.camera.world_from_camera, config.steady);
  }
  {
    const ScopedTimer clock(events_s);
    const Stabilizer stabilizer(camera, result.camera.world_from_camera);
    result.stretches = cut(input.events, config.window_s);
    parallel_for(result.stretches.size(), [&](std::size_t i) {
      StabilizedStretch& stretch = result.stretches[i];
      const double at_s = stretch.window.at_s;
      const Eigen::Quaterniond steady = result.world_from_steady.at_clamped(at_s).rotation();
      stretch.window.steady_from_camera =
          steady.conjugate() * result.camera.world_from_camera.at_clamped(at_s).rotation();
      stretch.stabilized = stabilizer.stabilize(stretch.events, steady);
    });
  }
  timing.wall_s.push_back(orientation_s + events_s);
  timing.stages_s = {{"orientation", orientation_s}, {"events", events_s}};
}

void write(const std::filesystem::path& folder, const Dataset& dataset,
           const StabilizeConfig& config, const Stabilization& result,
           const RunRecord::Window& window) {
  write_orientations(folder / "orientation.txt", result.camera.world_from_camera.poses());
  if (!result.camera.gyro.empty()) write_gyro_biases(folder / "gyro_bias.txt", result.camera.gyro);
  if (!result.stretches.empty())
    write_stabilized_events(folder / "stabilized", dataset.camera(), result.stretches);
  if (config.frames)
    write_stabilized_frames(folder / "stabilized", dataset, window,
                            Stabilizer(dataset.camera(), result.camera.world_from_camera),
                            result.world_from_steady);
}

}  // namespace

RunSummary run_stabilization(const RunRequest& request) {
  const auto config = read_config<StabilizeConfig>(request);
  RunWriter writer(request);

  RunTiming timing;
  const Dataset dataset = Dataset::open(request.dataset);
  StabilizeInput input;
  {
    const ScopedTimer clock(timing.io_s);
    input = load_input(request, dataset);
  }
  timing.events = input.events.size();
  Stabilization result;
  Progress progress("stabilize", timing.events * static_cast<std::size_t>(request.repeat),
                    "events");
  for (int i = 0; i < request.repeat; ++i) {
    stabilize(input, config, dataset.camera(), result, timing);
    progress.add(timing.events);
  }
  const Trajectory& poses = result.camera.world_from_camera;
  timing.sequence_s = poses.end_s() - poses.start_s();
  // A length alone counts from the first event on, as it did when these were loaded.
  const bool is_from_events = request.duration_s && !input.events.empty();
  const double first_s =
      is_from_events ? seconds_from_ns(input.events.front().t_ns) : poses.start_s();
  const RunRecord::Window window = window_of(request, first_s, poses.end_s());
  {
    const ScopedTimer clock(timing.io_s);
    write(writer.path(), dataset, config, result, window);
  }
  writer.finish("stabilize", request, dataset, window, config.seed, config::print(config), timing);

  return summary_of(timing, fmt::format("{} orientations, {} windows of events", poses.size(),
                                        result.stretches.size()));
}

std::string print_stabilization_config(const config::Document& document) {
  return config::print_documented(config::read<StabilizeConfig>(document));
}

}  // namespace saccade
