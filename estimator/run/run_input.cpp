#include "estimator/run/run_input.h"

#include <fmt/core.h>

#include <limits>

#include "core/error.h"
#include "core/io/trajectory_file.h"
#include "core/process/progress.h"
#include "core/time_search.h"

namespace saccade {

void check(const RunRequest& request) {
  if (request.repeat < 1) throw InputError("--repeat", "must be at least 1");
  if (request.duration_s && !(*request.duration_s > 0))
    throw InputError("--duration-s", "must be above 0");
}

Events load_events_if_any(const RunRequest& request, const Dataset& dataset) {
  const double infinity = std::numeric_limits<double>::infinity();
  const double start_s = request.start_s.value_or(-infinity);
  if (!request.duration_s) return dataset.load_events(start_s);
  if (request.start_s) return dataset.load_events(start_s, start_s + *request.duration_s);
  // The start is the first event, which only the file knows.
  Events events = dataset.load_events();
  if (events.empty()) return events;
  const TimeNs end_ns = events.front().t_ns + ns_from_seconds(*request.duration_s);
  events.resize(count_before(events, end_ns));
  return events;
}

Events load_events(const RunRequest& request, const Dataset& dataset) {
  Events events = load_events_if_any(request, dataset);
  if (events.empty())
    throw InputError(dataset.folder().string(), "holds no events in the window that was asked for");
  return events;
}

RunRecord::Window window_of(const RunRequest& request, double first_s, double last_s) {
  RunRecord::Window window;
  window.start_s = request.start_s.value_or(first_s);
  window.end_s = request.duration_s ? window.start_s + *request.duration_s : last_s;
  return window;
}

namespace {

/// Of jitter, between one pose and the next: by less the events themselves are uncertain.
constexpr double kVisibleJitter_px = 1.0 / 3;

Trajectory recorded_poses(const RunRequest& request, const Dataset& dataset) {
  if (request.poses_from) {
    const std::filesystem::path& from = *request.poses_from;
    if (!std::filesystem::is_directory(from)) return read_trajectory(from);
    const bool has_orientations_only = !std::filesystem::exists(from / "trajectory.txt") &&
                                       std::filesystem::exists(from / "orientation.txt");
    return has_orientations_only ? read_orientations(from / "orientation.txt")
                                 : read_trajectory(from / "trajectory.txt");
  }
  if (dataset.groundtruth().empty())
    throw InputError(dataset.folder().string(),
                     "holds no groundtruth.txt; name a run or a trajectory: --poses-from RUN");
  return dataset.groundtruth();
}

void warn_of_noise(const PoseNoise& noise, const PinholeCamera& camera) {
  const double jitter_px = camera.fx * noise.rotation_rad;
  if (jitter_px > kVisibleJitter_px)
    show_notice(
        fmt::format("the poses jitter by {:.2g} mrad, {:.2g} px, from one to the next; "
                    "--smooth-poses fits a smooth motion through them",
                    1e3 * noise.rotation_rad, jitter_px));
}

}  // namespace

GivenPoses load_poses(const RunRequest& request, const Dataset& dataset) {
  GivenPoses given{recorded_poses(request, dataset), {}};
  given.noise = pose_noise_of(given.trajectory);
  if (!request.smooth_poses_s)
    warn_of_noise(given.noise, dataset.camera());
  else if (given.trajectory.size() > 1)
    given.trajectory = smoothed(given.trajectory, *request.smooth_poses_s);
  return given;
}

}  // namespace saccade
