#include "estimator/odometry/odometry_output.h"

#include <fmt/core.h>

#include <vector>

#include "core/config/config.h"
#include "core/io/files/atomic_file.h"
#include "core/io/run/view_list.h"
#include "estimator/depth/depth_output.h"
#include "estimator/reconstruction/reconstruction_output.h"
#include "estimator/tracking/pose_output.h"

namespace saccade {
namespace {

RunView write_view(const std::filesystem::path& folder, std::size_t index,
                   const PinholeCamera& camera, const Keyframe& keyframe) {
  RunView view;
  view.t_s = keyframe.t_s;
  view.world_from_camera = keyframe.world_from_camera;
  view.start_s = keyframe.start_s;
  view.end_s = keyframe.end_s;
  view.depth = folder / "depth" / fmt::format("depth_{:08}.exr", index);
  write_depth_map(view.depth, camera, keyframe.depth);
  if (keyframe.image.log_image.empty()) return view;
  view.gradient = folder / "gradient" / fmt::format("gradient_{:08}.exr", index);
  view.image = folder / "image" / fmt::format("image_{:08}.exr", index);
  write_image_view(keyframe.image, view);
  return view;
}

KeyframeEntry entry_of(const Keyframe& keyframe) {
  KeyframeEntry entry;
  entry.t_s = keyframe.t_s;
  entry.world_from_camera = keyframe.world_from_camera;
  entry.made_s = entry.taken_s = keyframe.end_s;
  entry.events = static_cast<std::int64_t>(keyframe.events);
  entry.points = static_cast<std::int64_t>(keyframe.depth.points.size());
  entry.edges = static_cast<std::int64_t>(keyframe.edges.size());
  entry.typical_depth_m = keyframe.typical_depth_m;
  return entry;
}

struct StartRecord {
  int format_version = 1;
  double depth_m = 1;
  double start_s = 0, end_s = 0;
  double parallax_px = 0;
  int edges = 0;
  double residual_px = 0;
};

void describe(config::Fields& fields, StartRecord& record) {
  fields.value("format_version", record.format_version, "layout of this file");
  fields.value("depth_m", record.depth_m, "the scale: the typical depth is called so");
  fields.value("start_s", record.start_s, "of the path; its first pose is the identity");
  fields.value("end_s", record.end_s, "of the path");
  fields.value("parallax_px", record.parallax_px, "of the typical depth, over the path");
  fields.value("edges", record.edges, "found with it");
  fields.value("residual_px", record.residual_px, "robust deviation of their events");
}

}  // namespace

void write_keyframes(const std::filesystem::path& folder, const PinholeCamera& camera,
                     std::span<const Keyframe> keyframes, std::span<const KeyframeEntry> entries) {
  std::filesystem::create_directories(folder / "depth");
  std::vector<RunView> views;
  MapPoints map;
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    views.push_back(write_view(folder, i, camera, keyframes[i]));
    append(map, keyframes[i].edges);
  }
  write_view_list(folder / "views.yaml", views);
  write_keyframe_list(folder / "keyframes.yaml", entries);
  write_map(folder / "map.ply", map, Rigid3());
}

void write_odometry(const std::filesystem::path& folder, const PinholeCamera& camera,
                    const OdometryResult& result, std::span<const Keyframe> keyframes) {
  for (const char* name : {"gradient", "image"}) std::filesystem::create_directories(folder / name);
  std::vector<KeyframeEntry> entries;
  for (const Keyframe& keyframe : keyframes) entries.push_back(entry_of(keyframe));
  entries.front().active = {0};
  for (const KeyframeChange& change : result.changes) {
    entries[change.keyframe].made_s = change.made_s;
    entries[change.keyframe].taken_s = change.taken_s;
    entries[change.keyframe].active.assign(change.active.begin(), change.active.end());
  }
  write_keyframes(folder, camera.undistorted(), keyframes, entries);
  write_poses(folder, result.poses);
}

void write_start(const std::filesystem::path& file, const Bootstrap& start, double depth_m) {
  StartRecord record;
  record.depth_m = depth_m;
  record.start_s = start.path.start_s();
  record.end_s = start.path.end_s();
  record.parallax_px = start.parallax_px;
  record.edges = static_cast<int>(start.edges);
  record.residual_px = start.residual_px;
  write_atomically(file, config::print(record));
}

}  // namespace saccade
