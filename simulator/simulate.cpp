#include "simulator/simulate.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "core/config/config.h"
#include "core/io/dataset/dataset_writer.h"
#include "core/process/memory_limit.h"
#include "core/process/progress.h"
#include "core/stopwatch.h"
#include "simulator/colour_scenes.h"
#include "simulator/event_source.h"
#include "simulator/motion/motion.h"
#include "simulator/record_events.h"
#include "simulator/record_groundtruth.h"
#include "simulator/record_images.h"
#include "simulator/record_labels.h"
#include "simulator/resume.h"
#include "simulator/rig.h"
#include "simulator/scene/build_scene.h"
#include "simulator/sensor/adaptive/audit.h"
#include "simulator/sensor/texture_aliasing.h"

namespace saccade {
namespace {

DatasetRecord::Figure figure_of(const AuditFigure& figure) {
  return {figure.value, figure.low, figure.high};
}

DatasetRecord::Audit audit_record(const AuditResult& audit, AuditReference reference) {
  return {reference == AuditReference::kExact ? "exact" : "dense",
          static_cast<std::int64_t>(audit.pixels),
          static_cast<std::int64_t>(audit.exact_events),
          figure_of(audit.precision_10us),
          figure_of(audit.recall_10us),
          figure_of(audit.precision_1us),
          figure_of(audit.recall_1us),
          figure_of(audit.p99_dt_us)};
}

const char* sampling_name(Sampling sampling) {
  switch (sampling) {
    case Sampling::kAdaptive:
      return "adaptive";
    case Sampling::kFrames:
      return "frames";
    default:
      return "exact";
  }
}

DatasetRecord facts(const CameraRecording& recording, const EventStatistics& events,
                    double path_length_m) {
  DatasetRecord record;
  record.seed = recording.config.seed;
  record.config_yaml = config::print(recording.config);
  record.duration_s = recording.duration_s();
  record.contrast_on = recording.events.contrast.on;
  record.contrast_off = recording.events.contrast.off;
  record.log_eps = recording.events.log_eps;
  record.rays = static_cast<std::int64_t>(events.rays);
  record.lit_points = static_cast<std::int64_t>(events.lit_points);
  record.surface_samples = static_cast<std::int64_t>(events.surface_samples);
  if (recording.events.noise.readout.on())
    record.lost_events = static_cast<std::int64_t>(events.lost);
  const Sampling sampling = chosen_sampling(recording.events.sampling, recording.scene);
  record.sampling = sampling_name(sampling);
  if (recording.events.sampling == Sampling::kAuto)
    record.sampling_reason = sampling_reason(recording.events.sampling, recording.scene);
  if (sampling != Sampling::kAdaptive) record.time_bound_us = 1e6 * events.time_bound_s;
  if (const AuditResult& audit = recording.log.audit(); audit.pixels > 0)
    record.audit = audit_record(audit, audit_reference(recording.scene));
  record.path_length_m = path_length_m;
  return record;
}

/// Refuses sensors whose recording does not fit into memory, before it begins.
void check_pixels(std::span<const RigCamera> cameras) {
  // Measured from 160 x 120 to 2560 x 1920 pixels with two threads; what scenes, events and images take comes on top.
  constexpr double kBytesPerPixel = 220;
  for (std::size_t i = 0; i < cameras.size(); ++i) {  // they record one after the other
    const PinholeCamera& camera = cameras[i].camera;
    const std::string name = i == 0 ? "camera" : fmt::format("rig[{}].camera", i - 1);
    check_memory(kBytesPerPixel * camera.width * camera.height, name,
                 fmt::format("recording {} x {} pixels", camera.width, camera.height),
                 "lower width and height");
  }
}

/// Records what one camera sees; the first one carries the IMU.
CameraReport record_camera(const CameraRecording& recording, bool is_first,
                           const std::string& name) {
  const Stopwatch images;
  CameraReport report;
  const double path_length_m = record_groundtruth(recording);
  if (is_first) record_imu(recording);
  if (is_first) record_panorama(recording);
  record_images(recording);
  DatasetRecord::Counts labels;
  record_labels(recording, labels);
  report.images_s = images.seconds();
  const Stopwatch events;
  report.events = record_events(recording);
  report.events_s = events.seconds();
  DatasetRecord record = facts(recording, report.events, path_length_m);
  record.name = name;
  record.counts = labels;
  report.record = recording.writer.finish(std::move(record));
  return report;
}

}  // namespace

std::int64_t CameraReport::event_count() const {
  return record.counts ? record.counts->events_on + record.counts->events_off : 0;
}

SimulationReport simulate(const SimulationConfig& config, const std::filesystem::path& output) {
  const Stopwatch watch;
  SimulationReport report;
  const InputLog inputs;
  const std::vector<RigCamera> cameras = rig_cameras(config);
  check_pixels(cameras);
  const std::vector<ChainCamera> chain = camera_chain(cameras, config.imu);
  const Spline motion =
      cut_motion(build_motion(config.trajectory), config.start_s, config.duration_s);
  const Scene scene = build_scene(config.scene);
  for (const RigCamera& camera : cameras)
    static_cast<void>(chosen_sampling(camera.events.sampling, scene));  // or an error, at once
  const EventOptions& events = cameras.front().events;
  if (const std::string warning =
          aliasing_warning(texels_per_ray(scene, motion, cameras.front().camera, events), events);
      !warning.empty())
    show_warning(warning);
  const std::optional<ColourScenes> colours = build_colour_scenes(config, cameras);
  report.load_s = watch.seconds();

  ResumableFolder folder(output, "dataset.yaml", fingerprint_of(config, inputs));
  const EventLogs logs = open_logs(folder, cameras.size(), motion.end_s());
  report.cameras.resize(cameras.size());
  // The first camera comes last, because its dataset.yaml states the hashes of the others' files.
  for (std::size_t i = cameras.size(); i-- > 0;) {
    const RigCamera& camera = cameras[i];
    const bool is_first = i == 0;
    const Spline camera_motion = is_first ? motion : motion.attached(camera.camera0_from_camera);
    DatasetWriterOptions options{camera.events.timestamp_unit, false, config.frames.tone, {}};
    options.chain = is_first ? chain : std::vector<ChainCamera>{{camera.camera, {}, {}}};
    const auto within = [&](const std::filesystem::path& root) {
      return is_first ? root : root / camera.folder;
    };
    DatasetWriter writer(within(folder.path()), camera.camera, options);
    const CameraRecording recording{config,      camera.camera, camera.events,
                                    camera.seed, scene,         camera_motion,
                                    writer,      *logs[i],      colours ? &*colours : nullptr};
    report.cameras[i] =
        record_camera(recording, is_first, within(folder.target().filename()).generic_string());
  }
  folder.commit();
  report.total_s = watch.seconds();
  return report;
}

}  // namespace saccade
