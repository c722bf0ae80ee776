#include "estimator/refinement/refinement_config.h"

#include <fmt/core.h>

#include <limits>

#include "core/error.h"
#include "core/io/covariance_file.h"
#include "core/process/progress.h"
#include "core/stopwatch.h"
#include "estimator/edges/least_squares/path_covariance.h"
#include "estimator/run/repeat.h"
#include "estimator/run/run_input.h"
#include "estimator/tracking/pose_output.h"
#include "estimator/tracking/reference_view.h"
#include "estimator/tracking/track_config.h"

namespace saccade {
namespace {

/// Those of the configuration, of the run's, of the dataset, or those that the run found.
EventContrast contrast_of(const RefinementConfig& config, const TrackConfig& tracked,
                          const SourceRun& run, const Dataset& dataset) {
  const DatasetFacts& facts = dataset.facts();
  std::optional<double> on = config.contrast_on, off = config.contrast_off;
  if (!on) on = tracked.contrast_on ? tracked.contrast_on : facts.contrast_on;
  if (!off) off = tracked.contrast_off ? tracked.contrast_off : facts.contrast_off;
  if (!on && run.record.contrast) on = run.record.contrast->on;
  if (!off && run.record.contrast) off = run.record.contrast->off;
  if (!on || !off)
    throw InputError(dataset.folder().string(),
                     "does not state its contrast thresholds; state poses.contrast_on and "
                     "poses.contrast_off");
  return {*on, *off};
}

/// The run's poses begin and end with the means of some events; the path reaches over all of them.
void add_ends(const Events& events, std::vector<TrackedPose>& poses) {
  TrackedPose end;
  end.t_ns = end.first_ns = end.last_ns = events.front().t_ns;
  if (end.t_ns < poses.front().t_ns) poses.insert(poses.begin(), end);
  end.t_ns = end.first_ns = end.last_ns = events.back().t_ns;
  if (end.t_ns > poses.back().t_ns) poses.push_back(end);
}

/// The poses of the run, replaced by those of the path, and their covariances.
std::vector<StampedCovariance> replace_poses(const RefinedPath& path, const Rigid3& world_from_map,
                                             std::vector<TrackedPose>& poses) {
  const Spline spline = path.map_from_camera.spline();
  const double observations = static_cast<double>(std::max<std::size_t>(1, path.observations));
  for (TrackedPose& pose : poses) {
    pose.world_from_camera = world_from_map * spline.pose(seconds_from_ns(pose.t_ns));
    pose.status = path.observations > 0 ? TrackStatus::kOk : TrackStatus::kLost;
    pose.iterations = static_cast<int>(path.costs.steps().size());
    pose.inlier_ratio = static_cast<double>(path.inliers) / observations;
    pose.residual = path.residual;
    // What the run said of its own pose does not hold of this one.
    pose.probability = std::numeric_limits<double>::quiet_NaN();
  }
  if (path.covariances.empty()) return {};
  return set_sigmas(poses, [&](double t_s) { return path.covariance_at(t_s); });
}

}  // namespace

RunSummary refine_poses(const RunRequest& asked, const RefinementConfig& config,
                        const Dataset& dataset, const SourceRun& run, RunWriter& writer) {
  RunTiming timing;
  std::optional<ScopedTimer> io(timing.io_s);
  const RunRequest request = run.within(asked);
  const auto tracked = run.config<TrackConfig>();
  std::vector<TrackedPose> poses = run.poses();
  const Events events = load_events(request, dataset);
  const double first_s = seconds_from_ns(events.front().t_ns);
  const double last_s = seconds_from_ns(events.back().t_ns);
  const RunRecord::Window window = window_of(request, first_s, last_s);
  const PinholeCamera camera = tracked.camera.of(dataset.camera());
  const auto references =
      load_references(dataset, camera, tracked.reference, window.start_s, window.end_s);
  const EventContrast contrast = contrast_of(config, tracked, run, dataset);
  io.reset();

  const IntensityMap map(camera.undistorted(), references, IntensityMap::kEdgeBlur_px);
  const MapSurface surface(map);
  std::vector<StampedPose> start = poses_not_lost(poses, first_s, last_s, run.folder.string());
  const Rigid3 map_from_world = map.world_from_map().inverse();
  for (StampedPose& pose : start) pose.world_from_camera = map_from_world * pose.world_from_camera;
  add_ends(events, poses);
  RefinedPath path;
  Progress progress("refine", events.size() * static_cast<std::size_t>(request.repeat), "events");
  repeat_timed(request.repeat, timing.wall_s, [&] {
    path = refine_path(surface, camera, contrast, events, start, config.poses);
    progress.add(events.size());
  });
  timing.events = events.size();
  timing.poses = poses.size();
  timing.sequence_s = window.end_s - window.start_s;

  io.emplace(timing.io_s);
  const auto covariances = replace_poses(path, map.world_from_map(), poses);
  write_poses(writer.path(), poses);
  if (!covariances.empty()) write_covariances(writer.path() / "covariance.txt", covariances);
  path.costs.save(writer.path() / "cost.csv");
  if (std::filesystem::exists(run.folder / "map.ply"))
    std::filesystem::copy_file(run.folder / "map.ply", writer.path() / "map.ply");
  io.reset();
  writer.finish("refine", request, dataset, window, config.seed, config::print(config), timing);

  RunSummary summary =
      summary_of(timing, fmt::format("{} poses by {} events, residual {:.3f}", poses.size(),
                                     path.observations, path.residual));
  summary.lost_poses = count_lost(poses);
  return summary;
}

}  // namespace saccade
