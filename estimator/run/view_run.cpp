#include "estimator/run/view_run.h"

#include "core/check.h"
#include "core/error.h"
#include "estimator/run/run_input.h"

namespace saccade {

ViewInput load_view_input(const RunRequest& request, const Dataset& dataset, RunTiming& timing) {
  const ScopedTimer clock(timing.io_s);
  ViewInput input;
  input.trajectory = load_poses(request, dataset);
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

void add_stages(StageSeconds& sums, const StageSeconds& stages) {
  if (sums.empty()) {
    sums = stages;
    return;
  }
  SACCADE_CHECK(sums.size() == stages.size());
  for (std::size_t i = 0; i < sums.size(); ++i) sums[i].second += stages[i].second;
}

}  // namespace saccade
