#include "estimator/depth/depth_module.h"

#include <fmt/core.h>

#include <cmath>

#include "core/config/config.h"
#include "estimator/depth/depth_config.h"
#include "estimator/depth/depth_output.h"
#include "estimator/run/run_input.h"
#include "estimator/run/run_writer.h"
#include "estimator/run/view_run.h"

namespace saccade {
namespace {

/// Mean depth of the scene; the geometric mean of the limits where the dataset does not state it.
double mean_depth_of(const Dataset& dataset, const DepthLimits& limits) {
  return dataset.facts().mean_depth_m.value_or(std::sqrt(limits.near_m * limits.far_m));
}

}  // namespace

RunSummary run_depth(const RunRequest& request) {
  const auto config = read_config<DepthConfig>(request);
  RunWriter writer(request);

  RunTiming timing;
  const Dataset dataset = Dataset::open(request.dataset);
  const ViewInput input = load_view_input(request, dataset, timing);
  const auto windows =
      cut_windows(input.events(), input.trajectory, config.window, dataset.frames());
  const auto estimator =
      make_depth_estimator(config, dataset.camera(), mean_depth_of(dataset, config.limits));
  const auto results = estimate_views<DepthResult>(
      "depth", windows, request.repeat, timing,
      [&](const ViewWindow& window) { return estimator->estimate(window); });
  {
    const ScopedTimer clock(timing.io_s);
    write_depth(writer.path(), dataset.camera(), windows, results);
  }
  writer.set_class(class_of_views(request, config.window));
  writer.finish("depth", request, dataset, input.window, config.seed, config::print(config),
                timing);

  std::size_t points = 0;
  for (const DepthResult& result : results) points += result.points.size();
  return summary_of(timing, fmt::format("{} points in {} views", points, windows.size()));
}

}  // namespace saccade
