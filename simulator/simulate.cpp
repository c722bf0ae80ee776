#include "simulator/simulate.h"

#include <chrono>
#include <utility>

#include "core/config/config.h"
#include "core/io/dataset_writer.h"
#include "simulator/motion/motion.h"
#include "simulator/record_events.h"
#include "simulator/record_groundtruth.h"
#include "simulator/record_images.h"
#include "simulator/scene/scene_builder.h"
#include "simulator/unfinished.h"

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
  const InputLog inputs;
  const Spline motion =
      cut_motion(build_motion(config.trajectory), config.start_s, config.duration_s);
  const Scene scene = build_scene(config.scene);
  report.load_s = watch.lap();

  ResumableFolder folder(output, "dataset.yaml", fingerprint_of(config, inputs));
  const EventLogs logs = open_logs(folder, 1, motion.end_s());
  DatasetWriter writer(folder.path(), config.camera, {config.events.timestamp_unit});
  const Take take{config, config.camera, config.events, scene, motion, writer, *logs.front()};
  report.path_length_m = record_groundtruth(take);
  record_imu(take);
  record_images(take);
  report.images_s = watch.lap();
  report.events = record_events(take);
  report.events_s = watch.lap();
  DatasetRecord record = facts(take, report);
  record.name = folder.target().filename().string();
  report.record = writer.finish(std::move(record));
  folder.commit();
  report.total_s = whole.lap();
  return report;
}

}  // namespace saccade
