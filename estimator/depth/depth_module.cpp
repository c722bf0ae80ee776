#include "estimator/depth/depth_module.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <string>

#include "core/config/config.h"
#include "core/process/progress.h"
#include "estimator/depth/depth_config.h"
#include "estimator/depth/depth_output.h"
#include "estimator/depth/still_windows.h"
#include "estimator/run/run_input.h"
#include "estimator/run/run_writer.h"
#include "estimator/run/view_run.h"

namespace saccade {
namespace {

/// Mean depth of the scene; the geometric mean of the limits where the dataset does not state it.
double mean_depth_of(const Dataset& dataset, const DepthLimits& limits) {
  return dataset.facts().mean_depth_m.value_or(std::sqrt(limits.near_m * limits.far_m));
}

/// Views that have few points or none, and why.
void say_what_is_poor(std::span<const DepthResult> results) {
  std::size_t empty = 0, opened = 0;
  double opening = 1;
  std::string why;
  for (const DepthResult& result : results) {
    if (result.points.empty()) {
      ++empty;
      why = result.why_empty;
    } else if (result.gate_opening > 1) {
      ++opened;
      opening = std::max(opening, result.gate_opening);
    }
  }
  if (opened > 0)
    show_notice(
        fmt::format("{} of {} views have few points or little parallax: their gates were "
                    "opened {} times (rays.least_points), and their depths are coarse, as "
                    "their sigmas say",
                    opened, results.size(), opening));
  if (empty > 0 && !why.empty())
    show_notice(
        fmt::format("{} of {} views are empty; of the last, {}", empty, results.size(), why));
}

/// A delay that moves edges of a fast camera by a tenth of a pixel: clocks are to be looked at, or a sensor is congested.
void say_how_late(std::span<const DepthResult> results) {
  constexpr double kNotable_s = 2e-4;
  double largest_s = 0;
  for (const DepthResult& result : results)
    if (std::abs(result.event_delay_s) > std::abs(largest_s)) largest_s = result.event_delay_s;
  if (std::abs(largest_s) >= kNotable_s)
    show_notice(
        fmt::format("events come up to {:.2g} ms {} than the poses say; it was taken out "
                    "(rays.find_delay)",
                    1e3 * std::abs(largest_s), largest_s > 0 ? "later" : "earlier"));
}

}  // namespace

RunSummary run_depth(const RunRequest& request) {
  auto config = read_config<DepthConfig>(request);
  config.rays = config.rays.for_given_poses();
  RunWriter writer(request);

  RunTiming timing;
  const Dataset dataset = Dataset::open(request.dataset);
  const ViewInput input = load_view_input(request, dataset, timing);
  const double mean_depth_m = mean_depth_of(dataset, config.limits);
  auto windows = join_still_windows(
      cut_windows(input.events(), input.trajectory, config.window, dataset.frames()),
      {dataset.camera().undistorted(), mean_depth_m, config.parallax_px}, config.window,
      dataset.frames());
  for (ViewWindow& window : windows) window.pose_noise = input.pose_noise;
  const auto estimator = make_depth_estimator(config, dataset.camera(), mean_depth_m);
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

  say_what_is_poor(results);
  say_how_late(results);
  std::size_t points = 0;
  for (const DepthResult& result : results) points += result.points.size();
  return summary_of(timing, fmt::format("{} points in {} views", points, windows.size()));
}

}  // namespace saccade
