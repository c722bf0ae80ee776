#pragma once

#include <string>

#include "core/config/config.h"
#include "core/event.h"
#include "core/io/dataset/dataset.h"
#include "core/io/run/run_record.h"
#include "core/pose_noise.h"
#include "core/trajectory.h"
#include "estimator/run/run_request.h"

namespace saccade {

/// Throws InputError where no module could do what is asked for.
void check(const RunRequest& request);

/// A module's configuration with the request's seed, which is checked, too.
template <class Config>
[[nodiscard]] Config read_config(const RunRequest& request) {
  auto config = config::read<Config>(request.config);
  if (request.seed) config.seed = *request.seed;
  check(request);
  return config;
}

/// The times of the events that were asked for: a duration alone counts from the first event of the
/// dataset, of which no more is read for that than its beginning.
[[nodiscard]] TimeWindow event_window(const RunRequest& request, const Dataset& dataset);

/// The dataset's events in the window that was asked for. Throws InputError where there are none.
[[nodiscard]] Events load_events(const RunRequest& request, const Dataset& dataset);
/// The InputError for a window without events.
[[noreturn]] void refuse_no_events(const Dataset& dataset);

/// The window [s] as run.yaml states it; `first_s` and `last_s` of what was loaded, where the
/// request leaves it open.
[[nodiscard]] RunRecord::Window window_of(const RunRequest& request, double first_s, double last_s);

/// world_from_camera of the run or the trajectory file at `poses_from`, without one the ground
/// truth, as recorded. Of a run that found orientations alone, these, at the origin. Throws
/// InputError where there is none.
[[nodiscard]] Trajectory recorded_poses(const RunRequest& request, const Dataset& dataset);

/// The poses smoothed by a spline where the request asks for it. Throws InputError where its knots
/// are too dense for them.
[[nodiscard]] Trajectory smoothed_as_asked(const RunRequest& request, Trajectory poses);

/// Throws InputError where --smooth-poses is asked for though no poses are read, with the reason.
void refuse_smoothing(const RunRequest& request, const std::string& reason);

/// What a module that takes poses was given.
struct GivenPoses {
  Trajectory trajectory;  ///< world_from_camera
  PoseNoise noise;        ///< of the poses as they were recorded
};

/// The recorded poses, smoothed as asked; where they jitter by more than a third of a pixel and are
/// not smoothed, that is said. Throws InputError where there is none.
[[nodiscard]] GivenPoses load_poses(const RunRequest& request, const Dataset& dataset);

}  // namespace saccade
