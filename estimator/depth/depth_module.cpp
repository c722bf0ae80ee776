#include "estimator/depth/depth_module.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "core/config/config.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/progress.h"
#include "estimator/depth/depth_config.h"
#include "estimator/depth/depth_output.h"
#include "estimator/depth/depth_windows.h"
#include "estimator/run_input.h"
#include "estimator/run_writer.h"
#include "estimator/stage_clock.h"

namespace saccade {
namespace {

/// Sums over the windows. With several threads they are processor seconds.
std::vector<std::pair<std::string, double>> sum_of_stages(const std::vector<DepthResult>& results) {
  std::vector<std::pair<std::string, double>> sums = results.front().stages_s;
  for (std::size_t i = 1; i < results.size(); ++i)
    for (std::size_t j = 0; j < sums.size(); ++j) sums[j].second += results[i].stages_s[j].second;
  return sums;
}

/// All windows, `repeat` times; the last results.
std::vector<DepthResult> estimate(const DepthEstimator& estimator,
                                  const std::vector<DepthWindow>& windows, int repeat,
                                  RunTiming& timing) {
  std::vector<DepthResult> results(windows.size());
  Progress progress("depth", timing.events * static_cast<std::size_t>(repeat), "events");
  for (int i = 0; i < repeat; ++i) {
    double wall_s = 0;
    {
      const StageClock clock(wall_s);
      parallel_for(windows.size(), [&](std::size_t k) {
        results[k] = estimator.estimate(windows[k]);
        progress.add(windows[k].events.size());
      });
    }
    timing.wall_s.push_back(wall_s);
  }
  timing.stages_s = sum_of_stages(results);
  return results;
}

/// Of the scene; where the dataset does not know, the middle of the range on a logarithmic scale.
double mean_depth_of(const Dataset& dataset, const DepthLimits& limits) {
  return dataset.facts().mean_depth_m.value_or(std::sqrt(limits.near_m * limits.far_m));
}

}  // namespace

RunSummary run_depth(const RunRequest& request) {
  DepthConfig config = config::read<DepthConfig>(request.config);
  if (request.seed) config.seed = *request.seed;
  check(request);
  RunWriter writer(request);

  RunTiming timing;
  RunSummary summary;
  const Dataset dataset = Dataset::open(request.dataset);
  Trajectory trajectory;
  Events loaded;
  {
    const StageClock clock(timing.io_s);
    trajectory = load_poses(request, dataset);
    loaded = load_events(request, dataset);
  }
  const std::span<const Event> events = within(loaded, trajectory);
  if (events.empty())
    throw InputError(dataset.folder().string(), "holds no events within the time of the poses");
  const auto windows = cut_windows(events, trajectory, config.window);
  timing.events = events.size();
  timing.sequence_s = seconds_from_ns(events.back().t_ns - events.front().t_ns);
  const auto estimator =
      make_depth_estimator(config, dataset.camera(), mean_depth_of(dataset, config.limits));
  const auto results = estimate(*estimator, windows, request.repeat, timing);
  {
    const StageClock clock(timing.io_s);
    write_depth(writer.path(), dataset.camera(), windows, results);
  }
  const RunRecord::Window window =
      window_of(request, seconds_from_ns(loaded.front().t_ns), seconds_from_ns(loaded.back().t_ns));
  writer.finish("depth", request, dataset, window, config.seed, config::print(config), timing);

  summary.events = events.size();
  summary.views = windows.size();
  for (const DepthResult& result : results) summary.points += result.points.size();
  summary.wall_s = median(timing.wall_s);
  return summary;
}

std::string print_depth_config(const config::Document& document) {
  return config::print_documented(config::read<DepthConfig>(document));
}

}  // namespace saccade
