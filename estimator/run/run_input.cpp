#include "estimator/run/run_input.h"

#include <fmt/core.h>

#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "core/error.h"
#include "core/io/trajectory_file.h"
#include "core/process/progress.h"

namespace saccade {

void check(const RunRequest& request) {
  if (request.repeat < 1) throw InputError("--repeat", "must be at least 1");
  if (request.duration_s && !(*request.duration_s > 0))
    throw InputError("--duration-s", "must be above 0");
  if (request.smooth_poses_s &&
      !(*request.smooth_poses_s > 0 && std::isfinite(*request.smooth_poses_s)))
    throw InputError("--smooth-poses", "must be a number of seconds above 0");
}

TimeWindow event_window(const RunRequest& request, const Dataset& dataset) {
  const double infinity = std::numeric_limits<double>::infinity();
  const double start_s = request.start_s.value_or(-infinity);
  if (!request.duration_s) return time_window(start_s, infinity);
  if (request.start_s) return time_window(start_s, start_s + *request.duration_s);
  // The start is the first event, which only the file knows.
  if (dataset.events_file().empty()) return {};
  const std::optional<TimeNs> first_ns = first_event_ns(dataset.events_file());
  const TimeNs duration_ns = time_window(0, *request.duration_s).end_ns;
  TimeWindow window;
  if (first_ns && __builtin_add_overflow(*first_ns, duration_ns, &window.end_ns))
    window.end_ns = TimeWindow().end_ns;
  return window;
}

void refuse_no_events(const Dataset& dataset) {
  throw InputError(dataset.folder().string(), "holds no events in the window that was asked for");
}

Events load_events(const RunRequest& request, const Dataset& dataset) {
  Events events = dataset.load_events(event_window(request, dataset));
  if (events.empty()) refuse_no_events(dataset);
  return events;
}

RunRecord::Window window_of(const RunRequest& request, double first_s, double last_s) {
  RunRecord::Window window;
  window.start_s = request.start_s.value_or(first_s);
  window.end_s = request.duration_s ? window.start_s + *request.duration_s : last_s;
  return window;
}

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

Trajectory smoothed_as_asked(const RunRequest& request, Trajectory poses) {
  if (!request.smooth_poses_s || poses.size() < 2) return poses;
  // Denser knots than poses follow their noise, and cost memory without bound.
  const double spacing_s =
      (poses.end_s() - poses.start_s()) / static_cast<double>(poses.size() - 1);
  if (*request.smooth_poses_s < spacing_s)
    throw InputError("--smooth-poses",
                     fmt::format("{:.3g} s is less than the {:.3g} s from one pose to the next",
                                 *request.smooth_poses_s, spacing_s));
  try {
    return smoothed(poses, *request.smooth_poses_s);
  } catch (const InputError& error) {
    throw InputError("--smooth-poses", error.what());
  }
}

void refuse_smoothing(const RunRequest& request, const std::string& reason) {
  if (request.smooth_poses_s) throw InputError("--smooth-poses", reason);
}

GivenPoses load_poses(const RunRequest& request, const Dataset& dataset) {
  /// Of jitter, between one pose and the next: by less the events themselves are uncertain.
  constexpr double kVisibleJitter_px = 1.0 / 3;
  GivenPoses given{recorded_poses(request, dataset), {}};
  given.noise = pose_noise_of(given.trajectory);
  const double jitter_px = dataset.camera().fx * given.noise.rotation_rad;
  if (jitter_px > kVisibleJitter_px && !request.smooth_poses_s)
    show_notice(
        fmt::format("the poses jitter by {:.2g} mrad, {:.2g} px, from one to the next; "
                    "--smooth-poses 0.04 fits a smooth motion through them",
                    1e3 * given.noise.rotation_rad, jitter_px));
  given.trajectory = smoothed_as_asked(request, std::move(given.trajectory));
  return given;
}

}  // namespace saccade
