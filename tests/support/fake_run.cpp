#include "tests/support/fake_run.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/io/dataset/dataset.h"
#include "core/io/dataset/dataset_writer.h"
#include "core/io/files/atomic_file.h"
#include "core/io/images/exr_file.h"
#include "core/io/ply_file.h"
#include "core/io/run/keyframe_list.h"
#include "core/io/run/run_record.h"
#include "core/io/run/view_list.h"
#include "core/io/tables/csv_file.h"
#include "core/io/trajectory_file.h"
#include "core/random.h"
#include "tests/support/planar_world.h"

namespace saccade::testing {
namespace {

constexpr double kPi = std::numbers::pi;

ImageF radiance_of(ImageF log_intensity) {
  for (float& value : log_intensity.pixels()) value = std::exp(value);
  return log_intensity;
}

std::vector<StampedPose> true_poses(double duration_s) {
  std::vector<StampedPose> poses;
  const auto count = static_cast<int>(std::lround(duration_s * 1000));
  for (int i = 0; i <= count; ++i) poses.push_back({i * 1e-3, corner_motion(i * 1e-3)});
  return poses;
}

/// The true pose with a slow wander and white noise on it.
Rigid3 erring_pose(const Rigid3& truth, double t_s, std::uint64_t index, const FakeErrors& errors) {
  const Random random(7);
  Eigen::Vector3d shift, rotation;
  for (int axis = 0; axis < 3; ++axis) {
    const auto stream = static_cast<std::uint64_t>(axis);
    const double wave = std::sin(2 * kPi * t_s * (0.8 + 0.3 * axis));
    shift[axis] = errors.slow_m * wave + errors.noise_m * random.normal(stream, index);
    rotation[axis] =
        (errors.slow_deg * wave + errors.noise_deg * random.normal(stream + 3, index)) * kPi / 180;
  }
  return {truth.rotation() * so3_exp(rotation), truth.translation() + shift};
}

PointCloud edge_points(const Dataset& dataset) {
  const ImageF frame = dataset.load_frame(0);
  const ImageF depth = dataset.load_depth(0);
  const Rigid3 world_from_camera = dataset.groundtruth().at_clamped(dataset.frames()[0].t_s);
  PointCloud cloud;
  for (int y = 1; y + 1 < frame.height(); ++y)
    for (int x = 1; x + 1 < frame.width(); ++x) {
      const double gx = std::log(frame(x + 1, y) / frame(x - 1, y));
      const double gy = std::log(frame(x, y + 1) / frame(x, y - 1));
      if (std::hypot(gx, gy) < 0.35 || !(depth(x, y) > 0)) continue;
      const Eigen::Vector3d ray = dataset.camera().ray(Eigen::Vector2d(x, y));
      cloud.positions.push_back((world_from_camera * (ray * depth(x, y))).cast<float>());
    }
  return cloud;
}

constexpr const char* kTiming = R"({
  "wall_s": {"median": 0.231, "min": 0.224, "max": 0.262},
  "events": 812345, "events_per_s": {"median": 3516645.0, "min": 3100553, "max": 3626540},
  "poses": 700, "poses_per_s": {"median": 3030.3, "min": 2671.8, "max": 3125.0},
  "realtime_factor": {"median": 4.33, "min": 3.82, "max": 4.46},
  "repetitions": 20,
  "stages_s": {"template": 0.092, "event_frame": 0.021, "align": 0.112},
  "io_s": 0.184, "peak_memory_mb": 96.5
}
)";

}  // namespace

void write_corner_dataset(const std::filesystem::path& folder, const std::string& name,
                          double duration_s, int width,
                          const std::function<bool(const Event&)>& is_kept) {
  const PlanarWorld world = corner_world(width, width * 3 / 4);
  DatasetWriter writer(folder, world.camera());
  // Crossings at the border of two simulated steps may be out of order by the last bit.
  Events events = world.simulate(corner_motion, 0, duration_s, 0.001, 0.15);
  std::sort(events.begin(), events.end(), EventOrder{});
  if (is_kept) std::erase_if(events, [&](const Event& event) { return !is_kept(event); });
  writer.write_events(events);
  const auto frames = static_cast<int>(duration_s * 24) + 1;
  for (int i = 0; i < frames; ++i) {
    const Rigid3 pose = corner_motion(i / 24.0);
    writer.write_frame(static_cast<std::size_t>(i), i / 24.0,
                       radiance_of(world.log_intensity(pose)));
    writer.write_depth(static_cast<std::size_t>(i), i / 24.0, world.depth(pose));
  }
  writer.write_groundtruth(true_poses(duration_s));
  DatasetRecord record;
  record.name = name;
  record.duration_s = duration_s;
  record.contrast_on = record.contrast_off = 0.15;
  (void)writer.finish(record);
}

void write_fake_run(const std::filesystem::path& folder, const std::filesystem::path& dataset,
                    const FakeErrors& errors, const std::string& configuration) {
  const Dataset data = Dataset::open(dataset);
  AtomicFolder target(folder, "run.yaml");
  const double duration_s = data.groundtruth().end_s();
  std::vector<StampedPose> poses;
  CsvTable csv(
      {"t_s", "first_event_s", "last_event_s", "status", "inlier_ratio", "iterations", "residual"});
  const auto count = static_cast<int>(duration_s * errors.rate_hz);
  for (int i = 0; i < count; ++i) {
    const double t_s = (i + 0.5) / errors.rate_hz;
    if (t_s >= errors.lost_from_s && t_s < errors.lost_until_s) continue;
    poses.push_back({t_s, erring_pose(data.groundtruth().at_clamped(t_s), t_s,
                                      static_cast<std::uint64_t>(i), errors)});
    const double half_s = 0.5 / errors.rate_hz;
    csv.add({t_s, t_s - half_s, t_s + half_s, "ok", 0.8, 30LL, 0.1});
  }
  write_tum_trajectory(target.path() / "trajectory.txt", poses);
  csv.save(target.path() / "poses.csv");
  write_atomically(target.path() / "timing.json", kTiming);
  write_ply(target.path() / "map.ply", edge_points(data));
  RunRecord record;
  record.module = "track";
  record.dataset = std::filesystem::absolute(dataset);
  record.window = RunRecord::Window{0, duration_s};
  record.seed = 1;
  record.threads = 1;
  record.tool_version = "0.1.0 (test)";
  record.command = "saccade run track --data corner -c " + configuration + ".yaml -o run";
  record.machine = "a machine, 2 cores";
  record.config_yaml = "samples: 500\niterations: 30\nevent_map_ratio: 0.4\n";
  write_run_record(target.path() / "run.yaml", record);
  target.commit();
}

void add_fake_keyframes(const std::filesystem::path& run, int count) {
  RunRecord record = read_run_record(run / "run.yaml");
  const PinholeCamera camera = Dataset::open(record.dataset).camera();
  const PlanarWorld world = corner_world(camera.width, camera.height);
  const PointCloud map = read_ply(run / "map.ply");
  std::vector<KeyframeEntry> keyframes;
  std::vector<RunView> views;
  for (int i = 0; i < count; ++i) {
    RunView view;
    view.t_s = 0.02 * (i + 1);
    view.world_from_camera = corner_motion(view.t_s);
    view.depth = run / ("depth_" + std::to_string(i) + ".exr");
    view.image = run / ("image_" + std::to_string(i) + ".exr");
    write_exr(view.depth, world.depth(view.world_from_camera), "Z");
    write_exr(view.image, world.log_intensity(view.world_from_camera), "L");
    views.push_back(view);
    KeyframeEntry keyframe;
    keyframe.t_s = keyframe.made_s = view.t_s;
    keyframe.taken_s = view.t_s + 0.01;
    keyframe.world_from_camera = view.world_from_camera;
    const auto size = static_cast<std::int64_t>(map.positions.size());
    keyframe.edges = size * (i + 1) / count - size * i / count;
    keyframe.active = {i};
    keyframes.push_back(keyframe);
  }
  write_view_list(run / "views.yaml", views);
  write_keyframe_list(run / "keyframes.yaml", keyframes);
  record.module = "odometry";
  write_run_record(run / "run.yaml", record);
}

}  // namespace saccade::testing
