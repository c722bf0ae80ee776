#include "simulator/simulate.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

#include "core/config/config.h"
#include "core/io/dataset_writer.h"
#include "core/io/imu_file.h"
#include "core/io/trajectory_file.h"
#include "core/parallel.h"
#include "core/progress.h"
#include "simulator/motion/motion.h"
#include "simulator/scene/scene_builder.h"
#include "simulator/sensor/event_camera.h"
#include "simulator/sensor/sample_times.h"
#include "simulator/sensor/view.h"

namespace saccade {
namespace {

class Stopwatch {
 public:
  /// Seconds since the construction or the last lap.
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    const double seconds = std::chrono::duration<double>(now - start_).count();
    start_ = now;
    return seconds;
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// One recording in the making: what the camera moves through and where it is written.
struct Take {
  const SimulationConfig& config;
  const Scene& scene;
  const Spline& world_from_camera;  ///< time 0 is the recording's start
  DatasetWriter& writer;

  [[nodiscard]] double duration_s() const { return world_from_camera.end_s(); }
  [[nodiscard]] StampedPose pose(double t_s) const { return {t_s, world_from_camera.pose(t_s)}; }
};

double write_groundtruth(const Take& take) {
  const TimeNs end = ns_from_seconds(take.duration_s());
  std::vector<StampedPose> poses;
  std::vector<StampedTwist> twists;
  for (const TimeNs t :
       merge_times({end}, sample_times(take.config.groundtruth.pose_rate_hz, take.duration_s()))) {
    const double t_s = seconds_from_ns(t);
    const SplineState state = take.world_from_camera.state(t_s);
    const Rigid3& pose = state.world_from_body;
    poses.push_back({t_s, pose});
    twists.push_back({t_s, pose.rotation().conjugate() * state.velocity_in_world,
                      state.angular_velocity_in_body});
  }
  take.writer.write_groundtruth(poses);
  write_twists(take.writer.folder() / "twist.txt", twists);
  return Trajectory(std::move(poses)).path_length();
}

void write_imu(const Take& take) {
  const ImuOptions& options = take.config.imu;
  if (options.rate_hz <= 0) return;
  const ImuRecording imu =
      record_imu(take.world_from_camera, options, take.config.gravity_m_s2, take.config.seed);
  take.writer.write_imu(imu.readings);
  write_imu_truth(take.writer.folder() / "imu_groundtruth.txt", imu.truth);
  write_imu_yaml(take.writer.folder() / "imu.yaml", options.calibration());
}

/// Poses whose views average to the frame at `t_s`: midpoints of equal parts of the exposure, as
/// many as keep the image motion between two of them below a quarter of a pixel.
std::vector<StampedPose> exposure_poses(const Take& take, const ViewRenderer& renderer,
                                        double t_s) {
  constexpr double kMotion_px = 0.25;
  constexpr double kMostPoses = 256;
  const double half_s = 0.5 * take.config.frames.exposure_s;
  if (half_s == 0) return {take.pose(t_s)};
  const double from_s = std::max(0.0, t_s - half_s);
  const double to_s = std::min(take.duration_s(), t_s + half_s);
  const FlowField flow = renderer.flow(take.world_from_camera.state(t_s), t_s);
  float speed = 0;
  for (std::size_t i = 0; i < flow.u.size(); ++i)
    speed = std::max(speed, std::hypot(flow.u.pixels()[i], flow.v.pixels()[i]));
  const double count = std::clamp(
      std::ceil(static_cast<double>(speed) * (to_s - from_s) / kMotion_px), 1.0, kMostPoses);
  std::vector<StampedPose> poses;
  for (double k = 0.5; k < count; ++k)
    poses.push_back(take.pose(from_s + (to_s - from_s) * k / count));
  return poses;
}

void write_images(const Take& take) {
  const ViewRenderer renderer(take.scene, take.config.camera, take.config.events.samples_per_pixel);
  const GroundtruthOptions& rates = take.config.groundtruth;
  const std::vector<TimeNs> frames = sample_times(take.config.frames.rate_hz, take.duration_s());
  const std::vector<TimeNs> depths =
      merge_times(frames, sample_times(rates.depth_rate_hz, take.duration_s()));
  const std::vector<TimeNs> flows = sample_times(rates.flow_rate_hz, take.duration_s());
  Progress progress("images", frames.size() + depths.size() + flows.size(), "images");
  parallel_for(frames.size(), [&](std::size_t i) {
    const double t = seconds_from_ns(frames[i]);
    take.writer.write_frame(i, t, renderer.radiance(exposure_poses(take, renderer, t)));
    progress.add(1);
  });
  parallel_for(depths.size(), [&](std::size_t i) {
    const double t = seconds_from_ns(depths[i]);
    take.writer.write_depth(i, t, renderer.depth(take.pose(t)));
    progress.add(1);
  });
  parallel_for(flows.size(), [&](std::size_t i) {
    const double t = seconds_from_ns(flows[i]);
    take.writer.write_flow(i, t, renderer.flow(take.world_from_camera.state(t), t));
    progress.add(1);
  });
}

EventStatistics write_events(const Take& take) {
  EventCamera camera(take.scene, take.world_from_camera, take.config.camera, take.config.events);
  const auto microseconds = [](double t_s) { return static_cast<std::uint64_t>(1e6 * t_s); };
  Progress progress("events", microseconds(take.duration_s()), "simulated us");
  double shown_s = 0;
  camera.record(take.duration_s(), [&](std::span<const Event> events, double t_s) {
    take.writer.write_events(events);
    progress.add(microseconds(t_s) - microseconds(shown_s));
    shown_s = t_s;
  });
  return camera.statistics();
}

DatasetRecord facts(const Take& take, const SimulationReport& report) {
  DatasetRecord record;
  record.seed = take.config.seed;
  record.config_yaml = config::print(take.config);
  record.duration_s = take.duration_s();
  record.contrast_on = take.config.events.contrast.on;
  record.contrast_off = take.config.events.contrast.off;
  record.log_eps = take.config.events.log_eps;
  record.rays = static_cast<std::int64_t>(report.events.rays);
  record.time_bound_us = 1e6 * report.events.time_bound_s;
  record.path_length_m = report.path_length_m;
  return record;
}

}  // namespace

std::int64_t SimulationReport::event_count() const {
  return record.counts ? record.counts->events_on + record.counts->events_off : 0;
}

SimulationReport simulate(const SimulationConfig& config, const std::filesystem::path& output) {
  config.camera.check("camera");
  Stopwatch whole;
  Stopwatch watch;
  SimulationReport report;
  const Spline motion =
      cut_motion(build_motion(config.trajectory), config.start_s, config.duration_s);
  const Scene scene = build_scene(config.scene);
  report.load_s = watch.lap();

  DatasetWriter writer(output, config.camera, {config.events.timestamp_unit});
  const Take take{config, scene, motion, writer};
  report.path_length_m = write_groundtruth(take);
  write_imu(take);
  write_images(take);
  report.images_s = watch.lap();
  report.events = write_events(take);
  report.events_s = watch.lap();
  report.record = writer.finish(facts(take, report));
  report.total_s = whole.lap();
  return report;
}

}  // namespace saccade
