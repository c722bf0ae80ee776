#include "estimator/mosaic/mosaic_module.h"

#include <fmt/core.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "core/blind_time.h"
#include "core/config/config.h"
#include "core/error.h"
#include "core/io/images/image_file.h"
#include "core/io/images/panorama_file.h"
#include "core/io/imu_file.h"
#include "core/io/trajectory_file.h"
#include "core/process/progress.h"
#include "core/stopwatch.h"
#include "estimator/imu/imu_input.h"
#include "estimator/imu/turning_events.h"
#include "estimator/mosaic/mosaic_config.h"
#include "estimator/mosaic/rate_offset.h"
#include "estimator/reconstruction/reconstruction_output.h"
#include "estimator/run/run_input.h"
#include "estimator/run/run_writer.h"
#include "estimator/run/view_windows.h"

namespace saccade {
namespace {

/// The input of a run.
struct MosaicSource {
  std::optional<ImuInput> imu;  ///< without one, another run's poses are used
  Trajectory poses;             ///< of that run
  Events events;
};

MosaicSource load_source(const RunRequest& request, const Dataset& dataset) {
  MosaicSource source;
  if (request.poses_from) {
    source.poses = load_poses(request, dataset).trajectory;
  } else {
    refuse_smoothing(request, "the orientation is the inertial sensor's; it is of --poses-from");
    source.imu = load_imu_input(dataset, "mosaic (or --poses-from RUN)");
    mark_turns(*source.imu, dataset);
  }
  source.events = load_events(request, dataset);
  return source;
}

struct MosaicRun {
  ImuPoses camera;                ///< without an inertial sensor its biases are empty
  std::span<const Event> events;  ///< within the time of the orientations
  Panorama panorama;
  Reconstruction mosaic;
};

double resolution_of(const PinholeCamera& camera, const MosaicConfig& config) {
  return config.panorama_px_per_rad.value_or(std::max(camera.fx, camera.fy));
}

Panorama panorama_of(const PinholeCamera& camera, const Trajectory& poses,
                     std::span<const Event> events, const MosaicConfig& config) {
  const double resolution = resolution_of(camera, config);
  if (config.extent == MosaicConfig::Extent::kSphere)
    return Panorama::sphere(pixels_around(resolution));
  return panorama_around(FieldOfView(camera), orientations_of(poses, events), resolution);
}

/// The orientations without the rate offset that the events imply; then aligned with gravity again with the
/// accelerometer, if there is one.
Trajectory corrected(const Trajectory& world_from_camera, std::span<const Event> events,
                     const MosaicSource& source, const PinholeCamera& camera,
                     const MosaicConfig& config) {
  const Eigen::Vector3d rate =
      sharpest_rate_offset(events, camera, world_from_camera, resolution_of(camera, config));
  const Trajectory without_offset =
      without_rate(world_from_camera, rate, seconds_from_ns(events.front().t_ns));
  return source.imu ? gravity_aligned(without_offset, *source.imu) : without_offset;
}

/// Everything but reading and writing.
MosaicRun run_once(const MosaicSource& source, const Dataset& dataset,
                   const ContrastThresholds& thresholds, const MosaicConfig& config,
                   RunTiming& timing, const ProgressCallback& progress) {
  double orientation_s = 0, offset_s = 0, wall_s = 0;
  MosaicRun run;
  {
    const ScopedTimer whole(wall_s);
    Trajectory& poses = run.camera.continuous;
    {
      const ScopedTimer clock(orientation_s);
      run.camera = source.imu ? camera_orientations(*source.imu, config.orientation)
                              : ImuPoses{source.poses, source.poses, {}};
    }
    run.events = within(source.events, poses);
    if (run.events.empty())
      throw InputError(dataset.folder().string(),
                       "holds no events within the time of the orientations");
    if (config.estimate_rate_offset) {
      const ScopedTimer clock(offset_s);
      poses = corrected(poses, run.events, source, dataset.camera(), config);
    }
    run.panorama = panorama_of(dataset.camera(), poses, run.events, config);
    run.mosaic = make_mosaic({dataset.camera(), run.events, poses, thresholds}, run.panorama,
                             config.mosaic, progress);
  }
  timing.wall_s.push_back(wall_s);
  timing.stages_s = {{"orientation", orientation_s}, {"rate_offset", offset_s}};
  timing.stages_s.insert(timing.stages_s.end(), run.mosaic.stages_s.begin(),
                         run.mosaic.stages_s.end());
  return run;
}

/// The picture, with unobserved pixels at half their brightness.
ImageU8 marked_picture(const Reconstruction& mosaic) {
  ImageU8 picture = grey_picture(mosaic.log_image, mosaic.observed);
  for (std::size_t i = 0; i < picture.size(); ++i)
    if (mosaic.observed.pixels()[i] == 0) picture.pixels()[i] /= 2;
  return picture;
}

void write(const std::filesystem::path& folder, const MosaicRun& run,
           std::span<const Snapshot> snapshots) {
  write_log_image(folder / "mosaic.exr", run.mosaic.log_image, run.mosaic.observed);
  write_png(folder / "mosaic.png", marked_picture(run.mosaic));
  write_panorama(folder / "mosaic.yaml", run.panorama);
  write_orientations(folder / "orientation.txt", run.camera.continuous.poses());
  if (!run.camera.gyro.empty()) write_gyro_biases(folder / "gyro_bias.txt", run.camera.gyro);
  write_snapshots(folder, snapshots);
}

}  // namespace

RunSummary run_mosaic(const RunRequest& request) {
  auto config = read_config<MosaicConfig>(request);
  RunWriter writer(request);

  RunTiming timing;
  const Dataset dataset = Dataset::open(request.dataset);
  MosaicSource source;
  {
    const ScopedTimer clock(timing.io_s);
    source = load_source(request, dataset);
  }
  const ContrastThresholds thresholds =
      contrast_thresholds(config.contrast_on, config.contrast_off, dataset, source.events);
  std::optional<double>& blind_time_us = config.mosaic.observations().blind_time_us;
  if (!blind_time_us)
    blind_time_us =
        find_blind_time_us(source.events, {dataset.camera().width, dataset.camera().height});
  const RunRecord::Window window = window_of(request, seconds_from_ns(source.events.front().t_ns),
                                             seconds_from_ns(source.events.back().t_ns));
  MosaicRun run;
  Progress progress("mosaic", source.events.size() * static_cast<std::size_t>(request.repeat),
                    "events");
  for (int i = 0; i < request.repeat; ++i) {
    std::size_t before = 0;
    run = run_once(source, dataset, thresholds, config, timing, [&](double fraction) {
      const auto now =
          static_cast<std::size_t>(fraction * static_cast<double>(source.events.size()));
      progress.add(now - std::exchange(before, now));
    });
  }
  const std::span<const Event> events = run.events;
  timing.events = events.size();
  timing.sequence_s = seconds_from_ns(events.back().t_ns - events.front().t_ns);
  const auto snapshots =
      take_snapshots(events, config.snapshot_events, [&](std::span<const Event> first) {
        return make_mosaic({dataset.camera(), first, run.camera.continuous, thresholds},
                           run.panorama, config.mosaic)
            .log_image;
      });
  {
    const ScopedTimer clock(timing.io_s);
    write(writer.path(), run, snapshots);
  }
  MethodClass method_class{{MethodInput::kEvents}, Processing::kBatch};
  if (source.imu) method_class.inputs.insert(MethodInput::kImu);
  writer.set_class(method_class);
  if (thresholds.is_found) writer.set_contrast({thresholds.on, thresholds.off});
  writer.finish("mosaic", request, dataset, window, config.seed, config::print(config), timing);

  return summary_of(timing, fmt::format("a mosaic of {} x {} px{}", run.panorama.width,
                                        run.panorama.height, found_text(thresholds)));
}

}  // namespace saccade
