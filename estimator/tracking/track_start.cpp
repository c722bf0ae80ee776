#include "estimator/tracking/track_start.h"

#include <fmt/core.h>

#include <cmath>

#include "core/error.h"

namespace saccade {
namespace {

Rigid3 initial_pose(const TrackConfig& config, const Dataset& dataset, double start_s) {
  if (config.initial_pose) {
    const auto& p = *config.initial_pose;
    const Eigen::Quaterniond q(p[6], p[3], p[4], p[5]);
    if (std::abs(q.norm() - 1) > 1e-3)
      throw InputError("initial_pose",
                       fmt::format("the quaternion has length {}, not 1", q.norm()));
    return {q, {p[0], p[1], p[2]}};
  }
  if (dataset.groundtruth().empty())
    throw InputError(dataset.folder().string(),
                     "holds no groundtruth.txt to start from; state initial_pose");
  return dataset.groundtruth().at_clamped(start_s);
}

/// Those of the configuration, else the dataset's; nullopt where neither states both.
std::optional<EventContrast> contrast_of(const TrackConfig& config, const Dataset& dataset) {
  const DatasetFacts& facts = dataset.facts();
  const auto on = config.contrast_on ? config.contrast_on : facts.contrast_on;
  const auto off = config.contrast_off ? config.contrast_off : facts.contrast_off;
  if (!on || !off) return std::nullopt;
  return EventContrast{*on, *off};
}

/// The map points of all views, in the frame of the first.
MapPoints edge_points_of(const TrackConfig& config, const PinholeCamera& camera,
                         const std::vector<ReferenceView>& views) {
  MapPoints all;
  const Rigid3 map_from_world = views.front().world_from_reference.inverse();
  for (const ReferenceView& view : views) {
    const MapPoints points = extract_map(view.log_intensity, view.depth, camera, config.map);
    append(all, transformed(map_from_world * view.world_from_reference, points));
  }
  return all;
}

}  // namespace

TrackStart load_track_start(const TrackConfig& config, const Dataset& dataset, double start_s,
                            double end_s) {
  TrackStart start;
  start.camera = config.camera.of(dataset.camera());
  start.references = load_references(dataset, start.camera, config.reference, start_s, end_s);
  start.world_from_camera = initial_pose(config, dataset, start_s);
  start.gyroscope = load_gyroscope(config.motion, dataset);
  start.contrast = contrast_of(config, dataset);
  return start;
}

TrackWorld world_of(const TrackConfig& config, const TrackStart& start) {
  const PinholeCamera undistorted = start.camera.undistorted();
  const double map_blur_px = method_of(config).smooths_map ? config.intensity.map_blur_px : 0;
  return {start.camera, edge_points_of(config, undistorted, start.references),
          IntensityMap(undistorted, start.references, map_blur_px), start.contrast,
          start.gyroscope};
}

}  // namespace saccade
