#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/check.h"
#include "core/error.h"
#include "core/event.h"
#include "core/io/dataset/dataset.h"
#include "core/io/run/method_class.h"
#include "core/io/run/run_record.h"
#include "core/process/parallel.h"
#include "core/process/progress.h"
#include "core/trajectory.h"
#include "estimator/run/repeat.h"
#include "estimator/run/run_input.h"
#include "estimator/run/run_request.h"
#include "estimator/run/run_writer.h"
#include "estimator/run/view_windows.h"

namespace saccade {

/// What a module that estimates one view per window of events starts from.
struct ViewInput {
  Trajectory trajectory;  ///< world_from_camera
  PoseNoise pose_noise;   ///< of the poses as they were recorded
  Events loaded;          ///< all in the window that was asked for
  RunRecord::Window window;

  /// Those that views can be estimated from.
  [[nodiscard]] std::span<const Event> events() const { return within(loaded, trajectory); }
};

/// Loads poses and events; fills the timing's io_s, events and sequence_s. Throws InputError where
/// poses are missing or no event lies within their time.
[[nodiscard]] inline ViewInput load_view_input(const RunRequest& request, const Dataset& dataset,
                                               RunTiming& timing) {
  const ScopedTimer clock(timing.io_s);
  ViewInput input;
  GivenPoses given = load_poses(request, dataset);
  input.trajectory = std::move(given.trajectory);
  input.pose_noise = given.noise;
  input.loaded = load_events(request, dataset);
  input.window = window_of(request, seconds_from_ns(input.loaded.front().t_ns),
                           seconds_from_ns(input.loaded.back().t_ns));
  const std::span<const Event> events = input.events();
  if (events.empty())
    throw InputError(dataset.folder().string(), "holds no events within the time of the poses");
  timing.events = events.size();
  timing.sequence_s = seconds_from_ns(events.back().t_ns - events.front().t_ns);
  return input;
}

/// Of a module whose views depend on the events of their own window alone: of those after the view,
/// too, unless it lies at the window's end.
[[nodiscard]] inline MethodClass class_of_views(const RunRequest& request,
                                                const ViewWindowOptions& windows) {
  MethodClass method{{MethodInput::kEvents}};
  if (windows.reference != ViewWindowOptions::Reference::kEnd)
    method.processing = Processing::kFixedLag;
  if (!request.poses_from) method.inputs.insert(MethodInput::kPoses);
  return method;
}

using StageSeconds = std::vector<std::pair<std::string, double>>;

/// Adds stages of the same names; a list that is empty takes the names over.
inline void add_stages(StageSeconds& sums, const StageSeconds& stages) {
  if (sums.empty()) {
    sums = stages;
    return;
  }
  SACCADE_CHECK(sums.size() == stages.size());
  for (std::size_t i = 0; i < sums.size(); ++i) sums[i].second += stages[i].second;
}

/// estimate(window) for every window, in parallel, `repeat` times; the last results, which state
/// their `stages_s`. Fills the timing's wall_s and stages_s; with several threads the stages are
/// processor seconds.
template <typename Result, typename Window, typename Estimate>
[[nodiscard]] std::vector<Result> estimate_views(const std::string& name,
                                                 const std::vector<Window>& windows, int repeat,
                                                 RunTiming& timing, const Estimate& estimate) {
  std::vector<Result> results(windows.size());
  Progress progress(name, timing.events * static_cast<std::size_t>(repeat), "events");
  repeat_timed(repeat, timing.wall_s, [&] {
    parallel_for(windows.size(), [&](std::size_t k) {
      results[k] = estimate(windows[k]);
      progress.add(windows[k].events.size());
    });
  });
  timing.stages_s.clear();
  for (const Result& result : results) add_stages(timing.stages_s, result.stages_s);
  return results;
}

}  // namespace saccade
