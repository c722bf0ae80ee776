#include "estimator/refinement/refinement_config.h"

#include <fmt/core.h>

#include "core/error.h"
#include "core/io/ply_file.h"
#include "core/io/run/view_list.h"
#include "core/process/parallel.h"
#include "core/stopwatch.h"
#include "core/time_search.h"
#include "estimator/depth/depth_config.h"
#include "estimator/depth/depth_output.h"
#include "estimator/refinement/depth/depth_refinement.h"
#include "estimator/run/repeat.h"
#include "estimator/run/run_input.h"

namespace saccade {
namespace {

std::span<const float> scalar(const PointCloud& cloud, const char* name,
                              const std::filesystem::path& file) {
  for (const PointCloud::Scalar& values : cloud.scalars)
    if (values.name == name) return values.values;
  throw InputError(file.string(), fmt::format("states no '{}' of its points", name));
}

/// The run's points, view by view.
std::vector<std::vector<EdgePoint>> points_of(const std::filesystem::path& folder,
                                              std::size_t views) {
  const std::filesystem::path file = folder / "cloud.ply";
  const PointCloud cloud = read_ply(file);
  const auto view = scalar(cloud, "view", file);
  const auto x = scalar(cloud, "x_px", file), y = scalar(cloud, "y_px", file);
  const auto depth = scalar(cloud, "depth_m", file), sigma = scalar(cloud, "sigma_m", file);
  std::vector<std::vector<EdgePoint>> points(views);
  for (std::size_t i = 0; i < cloud.positions.size(); ++i) {
    if (!(view[i] >= 0 && view[i] < static_cast<float>(views) && depth[i] > 0))
      throw InputError(file.string(), fmt::format("point {} belongs to no view of views.yaml, or "
                                                  "has no depth",
                                                  i));
    const float inverse = 1 / depth[i];
    points[static_cast<std::size_t>(view[i])].push_back(
        {x[i], y[i], inverse, sigma[i] * inverse * inverse});
  }
  return points;
}

/// The windows of the run's views, on the poses that it had.
std::vector<ViewWindow> windows_of(const std::vector<RunView>& views, std::span<const Event> events,
                                   const GivenPoses& poses) {
  std::vector<ViewWindow> windows;
  windows.reserve(views.size());
  for (const RunView& view : views) {
    windows.push_back(
        {events_within(events, ns_from_seconds(view.start_s), ns_from_seconds(view.end_s)),
         &poses.trajectory, view.t_s, poses.noise});
  }
  return windows;
}

void save_costs(const std::vector<RefinedDepth>& refined, const std::filesystem::path& file,
                double wall_s) {
  CostLog costs;
  for (const RefinedDepth& view : refined)
    costs.add_view(view.cost_before, view.cost_after, wall_s);
  costs.save(file);
}

}  // namespace

RunSummary refine_depth(const RunRequest& asked, const RefinementConfig& config,
                        const Dataset& dataset, const SourceRun& run, RunWriter& writer) {
  RunTiming timing;
  std::optional<ScopedTimer> io(timing.io_s);
  RunRequest request = run.within(asked);
  if (!request.poses_from && !run.record.poses_from.empty())
    request.poses_from = run.record.poses_from;
  if (!request.smooth_poses_s) request.smooth_poses_s = run.record.smooth_poses_s;
  auto method = run.config<DepthConfig>();
  method.rays = method.rays.for_given_poses();  // as the run did
  const GivenPoses given = load_poses(request, dataset);
  const Trajectory& poses = given.trajectory;
  const Events events = load_events(request, dataset);
  const std::vector<RunView> views = read_view_list(run.folder / "views.yaml");
  const auto points = points_of(run.folder, views.size());
  const auto windows = windows_of(views, within(events, poses), given);
  for (const ViewWindow& window : windows)
    if (window.events.empty())
      throw InputError(
          (run.folder / "views.yaml").string(),
          fmt::format("the view at {} s has no events with poses", window.reference_s));
  io.reset();

  const RayDepth depth(method.rays, method.limits, dataset.camera());
  std::vector<RefinedDepth> refined(windows.size());
  repeat_timed(request.repeat, timing.wall_s, [&] {
    parallel_for(windows.size(), [&](std::size_t k) {
      refined[k] = refine_depth_of(windows[k], points[k], dataset.camera(), depth);
    });
  });
  timing.events = events.size();
  timing.sequence_s = seconds_from_ns(events.back().t_ns - events.front().t_ns);

  io.emplace(timing.io_s);
  std::vector<DepthResult> results;
  std::size_t edges = 0, found = 0;
  for (RefinedDepth& view : refined) {
    edges += view.edges;
    found += view.result.points.size();
    results.push_back(std::move(view.result));
  }
  write_depth(writer.path(), dataset.camera(), windows, results);
  save_costs(refined, writer.path() / "cost.csv", timing.wall_s.back());
  io.reset();
  const RunRecord::Window window =
      window_of(request, seconds_from_ns(events.front().t_ns), seconds_from_ns(events.back().t_ns));
  writer.finish("refine", request, dataset, window, config.seed, config::print(config), timing);

  return summary_of(
      timing, fmt::format("{} points from {} edges in {} views", found, edges, windows.size()));
}

}  // namespace saccade
