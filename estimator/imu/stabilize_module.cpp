#include "estimator/imu/stabilize_module.h"

#include <fmt/core.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/config/config.h"
#include "core/error.h"
#include "core/io/events/event_queue.h"
#include "core/io/imu_file.h"
#include "core/io/trajectory_file.h"
#include "core/process/parallel.h"
#include "core/process/progress.h"
#include "core/stopwatch.h"
#include "core/time_search.h"
#include "estimator/imu/imu_input.h"
#include "estimator/imu/stabilize_output.h"
#include "estimator/imu/stabilizer.h"
#include "estimator/imu/turning_events.h"
#include "estimator/run/run_input.h"
#include "estimator/run/run_writer.h"

namespace saccade {
namespace {

/// Events that are cut into windows together, so that all threads have some.
constexpr std::size_t kBatchEvents = std::size_t{1} << 20U;

/// Consecutive windows of equal length from the first event of a recording on; empty ones are left out.
class WindowCutter {
 public:
  explicit WindowCutter(double window_s) : length_ns_(ns_from_seconds(window_s)) {}

  /// Cuts off the windows that are complete; with `is_last` all of them. `events`: those that follow the
  /// windows before.
  [[nodiscard]] std::vector<std::span<const Event>> cut(std::span<const Event> events,
                                                        bool is_last) {
    std::vector<std::span<const Event>> windows;
    if (!start_ns_ && !events.empty()) start_ns_ = events.front().t_ns;
    while (!events.empty()) {
      const std::size_t size = count_before(events, begin_of(events.front()) + length_ns_);
      if (size == events.size() && !is_last) break;
      windows.push_back(events.first(size));
      events = events.subspan(size);
    }
    return windows;
  }
  /// Begin of the window that holds an event.
  [[nodiscard]] TimeNs begin_of(const Event& event) const {
    return *start_ns_ + (event.t_ns - *start_ns_) / length_ns_ * length_ns_;
  }
  [[nodiscard]] TimeNs length_ns() const { return length_ns_; }

 private:
  TimeNs length_ns_;
  std::optional<TimeNs> start_ns_;  ///< first event of the recording
};

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

/// What the events are moved by.
struct Orientations {
  ImuPoses camera;  ///< without an inertial sensor its biases are empty
  Trajectory world_from_smoothed;
};

Orientations find_orientations(const std::optional<ImuInput>& imu, const Trajectory& given_poses,
                               const StabilizeConfig& config) {
  Orientations found;
  found.camera =
      imu ? camera_orientations(*imu, config.orientation) : ImuPoses{given_poses, given_poses, {}};
  found.world_from_smoothed = smoothed_orientations(found.camera.continuous, config.smoothing);
  return found;
}

/// What was done with the events in one repetition.
struct Stabilization {
  std::size_t events = 0;
  std::size_t windows = 0;
  TimeNs first_ns = 0;  ///< where there are events
  double work_s = 0;    ///< without reading and writing
  double io_s = 0;
};

/// Moves the events of the queue batch by batch, so that memory does not grow with the recording, and
/// writes them into `folder` where one is given.
Stabilization stabilize_events(EventQueue& events, const Orientations& orientations,
                               const StabilizeConfig& config, const PinholeCamera& camera,
                               const std::filesystem::path* folder, Progress& progress) {
  Stabilization done;
  const Stabilizer stabilizer(camera, orientations.camera.continuous);
  WindowCutter cutter(config.window_s);
  std::optional<StabilizedEventsWriter> writer;
  std::size_t wanted = kBatchEvents;
  for (auto ahead = events.ahead(wanted); !ahead.empty(); ahead = events.ahead(wanted)) {
    const Stopwatch working;
    if (done.events == 0) done.first_ns = ahead.front().t_ns;
    const auto parts = cutter.cut(ahead, events.is_complete());
    // A window that reaches beyond what was read is waited for.
    wanted = parts.empty() ? 2 * ahead.size() : kBatchEvents;
    std::vector<StabilizedWindow> windows(parts.size());
    std::vector<std::vector<StabilizedEvent>> stabilized(parts.size());
    parallel_for(parts.size(), [&](std::size_t i) {
      windows[i] = window_at(cutter.begin_of(parts[i].front()), cutter.length_ns(),
                             orientations.camera.continuous, orientations.world_from_smoothed);
      const Rigid3 steady = orientations.world_from_smoothed.at_clamped(windows[i].at_s);
      stabilized[i] = stabilizer.stabilize(parts[i], steady.rotation());
    });
    done.work_s += working.seconds();
    if (folder && !parts.empty()) {
      const ScopedTimer writing(done.io_s);
      if (!writer) writer.emplace(*folder, camera);
      writer->append(windows, stabilized);
    }
    std::size_t count = 0;
    for (const auto& part : parts) count += part.size();
    events.drop(count);
    progress.add(count);
    done.events += count;
    done.windows += parts.size();
  }
  const ScopedTimer writing(done.io_s);
  if (writer) writer->close();
  return done;
}

void write(const std::filesystem::path& folder, const Dataset& dataset, const Orientations& found,
           const RunRecord::Window& window) {
  write_orientations(folder / "orientation.txt", found.camera.world_from_camera.poses());
  if (!found.camera.gyro.empty()) write_gyro_biases(folder / "gyro_bias.txt", found.camera.gyro);
  write_stabilized_frames(folder / "stabilized", dataset, window,
                          Stabilizer(dataset.camera(), found.camera.continuous),
                          found.world_from_smoothed);
}

}  // namespace

void describe(config::Fields& fields, StabilizeConfig& config) {
  fields.section("orientation", config.orientation,
                 "Orientation from the inertial sensor. Not used with --poses-from.");
  using LowPass = SmoothingOptions::LowPass;
  fields.choice(
      "low_pass", config.smoothing.low_pass,
      {{"centred", LowPass::kCentred}, {"causal", LowPass::kCausal}},
      "Low-pass filter of the steady orientation: forwards and then backwards in time, so "
      "that the view does not lag behind the camera and leave what it sees (`centred`), "
      "or forwards alone, as in the thesis (`causal`).");
  fields
      .value("time_constant_s", config.smoothing.time_constant_s,
             "Time constant of the low-pass filter of the steady orientation, in seconds, of each "
             "direction. Larger "
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
  {
    const ScopedTimer clock(timing.io_s);
    if (request.poses_from) {
      given_poses = load_poses(request, dataset).trajectory;
    } else {
      refuse_smoothing(request, "the orientation is the inertial sensor's; it is of --poses-from");
      imu = load_imu_input(dataset, "stabilize (or --poses-from RUN)");
    }
  }
  const bool has_events = !dataset.events_file().empty();
  if (imu && has_events) {
    const ScopedTimer clock(timing.io_s);
    mark_turns(*imu, dataset);
  }
  const TimeWindow event_times = event_window(request, dataset);
  Orientations found;
  Stabilization done;
  std::optional<Progress> progress;
  const std::filesystem::path folder = writer.path() / "stabilized";
  for (int i = 0; i < request.repeat; ++i) {
    double orientation_s = 0;
    {
      const ScopedTimer clock(orientation_s);
      found = find_orientations(imu, given_poses, config);
    }
    if (has_events) {
      EventQueue events(dataset.stream_events(event_times));
      if (!progress)
        progress.emplace("stabilize",
                         events.expected_count() * static_cast<std::uint64_t>(request.repeat),
                         "events");
      done = stabilize_events(events, found, config, dataset.camera(),
                              i + 1 == request.repeat ? &folder : nullptr, *progress);
      if (i + 1 == request.repeat) timing.io_s += done.io_s + events.waited_s();
    }
    timing.wall_s.push_back(orientation_s + done.work_s);
    timing.stages_s = {{"orientation", orientation_s}, {"events", done.work_s}};
  }
  timing.events = done.events;
  const Trajectory& poses = found.camera.world_from_camera;
  timing.sequence_s = poses.end_s() - poses.start_s();
  // --duration-s without --start-s counts from the first event, as it does when they are read.
  const bool is_from_events = request.duration_s && done.events > 0;
  const double first_s = is_from_events ? seconds_from_ns(done.first_ns) : poses.start_s();
  const RunRecord::Window window = window_of(request, first_s, poses.end_s());
  {
    const ScopedTimer clock(timing.io_s);
    write(writer.path(), dataset, found, window);
  }
  const bool is_smoothed =
      imu && config.orientation.method == OrientationOptions::Method::kSmoothed;
  const bool is_centred = config.smoothing.low_pass == SmoothingOptions::LowPass::kCentred;
  MethodClass method_class{{MethodInput::kEvents},
                           is_smoothed || is_centred ? Processing::kBatch : Processing::kCausal};
  if (imu) method_class.inputs.insert(MethodInput::kImu);
  writer.set_class(method_class);
  writer.finish("stabilize", request, dataset, window, config.seed, config::print(config), timing);

  return summary_of(
      timing, fmt::format("{} orientations, {} windows of events", poses.size(), done.windows));
}

}  // namespace saccade
