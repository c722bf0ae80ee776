#include "simulator/record_images.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/io/images/exr_file.h"
#include "core/panorama.h"
#include "core/process/parallel.h"
#include "core/process/progress.h"
#include "simulator/frame_renderer.h"
#include "simulator/sensor/sample_times.h"

namespace saccade {
namespace {

/// The fastest pixel at `t_s` [px/s].
double image_speed(const ImageRenderer& renderer, const Spline& motion, double t_s) {
  const FlowField flow = renderer.flow(motion.state(t_s), t_s);
  float speed = 0;
  for (std::size_t i = 0; i < flow.u.size(); ++i)
    speed = std::max(speed, std::hypot(flow.u.pixels()[i], flow.v.pixels()[i]));
  return static_cast<double>(speed);
}

/// An exposure, cut to the motion's span.
struct Exposure {
  double from_s, to_s;

  Exposure(const Spline& world_from_camera, double t_s, double exposure_s) {
    const auto cut = [&](double t) {
      return std::clamp(t, world_from_camera.start_s(), world_from_camera.end_s());
    };
    from_s = cut(t_s - 0.5 * exposure_s);
    to_s = cut(t_s + 0.5 * exposure_s);
  }

  /// The midpoints of equal parts.
  [[nodiscard]] std::vector<double> midpoints(std::size_t count) const {
    std::vector<double> times;
    for (double k = 0.5; k < static_cast<double>(count); ++k)
      times.push_back(from_s + (to_s - from_s) * k / static_cast<double>(count));
    return times;
  }
};

/// How many views an exposure of `exposure_s` between two times needs.
std::size_t view_count(const ImageRenderer& renderer, const Spline& world_from_camera,
                       const Exposure& between, double exposure_s) {
  constexpr double kMotion_px = 0.25;
  constexpr double kMaxTimes = 256;
  // At several instants, since the camera may turn round within the exposure.
  double speed = 0;
  for (const double part : {0.0, 0.25, 0.5, 0.75, 1.0})
    speed = std::max(speed, image_speed(renderer, world_from_camera,
                                        between.from_s + part * (between.to_s - between.from_s)));
  return static_cast<std::size_t>(
      std::clamp(std::ceil(speed * exposure_s / kMotion_px), 1.0, kMaxTimes));
}

std::vector<ImageF> exposed_image(const CameraRecording& recording, const FrameRenderer& renderer,
                                  double t_s) {
  const FrameOptions& frames = recording.config.frames;
  const Spline& motion = recording.world_from_camera;
  if (frames.readout_s > 0)
    return renderer.radiance(
        row_exposures(renderer.grey(), motion, t_s, frames.exposure_s, frames.readout_s));
  std::vector<StampedPose> poses;
  for (const double t : exposure_times(renderer.grey(), motion, t_s, frames.exposure_s))
    poses.push_back(recording.pose(t));
  const Exposure exposure(motion, t_s, frames.exposure_s);
  return renderer.radiance(poses,
                           (exposure.to_s - exposure.from_s) / static_cast<double>(poses.size()));
}

void record_frame(const CameraRecording& recording, const FrameRenderer& renderer,
                  std::size_t index, double t_s) {
  const std::vector<ImageF> exposed = exposed_image(recording, renderer, t_s);
  if (recording.config.frames.radiance == FrameOptions::Radiance::kExposed) {
    recording.writer.write_frame(index, t_s, exposed, exposed);
  } else {
    const std::vector<StampedPose> instant{recording.pose(t_s)};
    recording.writer.write_frame(index, t_s, exposed, renderer.radiance(instant));
  }
}

}  // namespace

std::vector<double> exposure_times(const ImageRenderer& renderer, const Spline& world_from_camera,
                                   double t_s, double exposure_s) {
  if (exposure_s <= 0) return {t_s};
  const Exposure exposure(world_from_camera, t_s, exposure_s);
  const double length_s = exposure.to_s - exposure.from_s;
  return exposure.midpoints(view_count(renderer, world_from_camera, exposure, length_s));
}

std::vector<RowExposure> row_exposures(const ImageRenderer& renderer,
                                       const Spline& world_from_camera, double t_s,
                                       double exposure_s, double readout_s) {
  const int height = renderer.camera().height;
  const Exposure whole(world_from_camera, t_s, exposure_s + readout_s);
  const std::size_t views =
      exposure_s > 0 ? view_count(renderer, world_from_camera, whole, exposure_s) : 1;
  std::vector<RowExposure> rows(static_cast<std::size_t>(height));
  for (int y = 0; y < height; ++y) {
    const double middle_s = t_s + (static_cast<double>(y) / (height - 1) - 0.5) * readout_s;
    const Exposure exposure(world_from_camera, middle_s, exposure_s);
    RowExposure& row = rows[static_cast<std::size_t>(y)];
    for (const double t : exposure.midpoints(views))
      row.poses.push_back({t, world_from_camera.pose(t)});
    row.span_s = (exposure.to_s - exposure.from_s) / static_cast<double>(views);
  }
  return rows;
}

void record_images(const CameraRecording& recording) {
  const FrameRenderer frame_renderer(recording);
  const ImageRenderer& renderer = frame_renderer.grey();
  const GroundtruthOptions& rates = recording.config.groundtruth;
  const std::vector<TimeNs> frames =
      sample_times(recording.config.frames.rate_hz, recording.duration_s());
  const std::vector<TimeNs> depths =
      merge_times(frames, sample_times(rates.depth_rate_hz, recording.duration_s()));
  const std::vector<TimeNs> flows = sample_times(rates.flow_rate_hz, recording.duration_s());
  Progress progress("images", frames.size() + depths.size() + flows.size(), "images");
  parallel_for(frames.size(), [&](std::size_t i) {
    const double t = seconds_from_ns(frames[i]);
    if (!recording.writer.take_up_frame(i, t)) record_frame(recording, frame_renderer, i, t);
    progress.add(1);
  });
  parallel_for(depths.size(), [&](std::size_t i) {
    const double t = seconds_from_ns(depths[i]);
    if (!recording.writer.take_up_depth(i, t))
      recording.writer.write_depth(i, t, renderer.depth(recording.pose(t)));
    progress.add(1);
  });
  parallel_for(flows.size(), [&](std::size_t i) {
    const double t = seconds_from_ns(flows[i]);
    if (!recording.writer.take_up_flow(i, t))
      recording.writer.write_flow(i, t, renderer.flow(recording.world_from_camera.state(t), t));
    progress.add(1);
  });
}

void record_panorama(const CameraRecording& recording) {
  const double fineness = recording.config.groundtruth.panorama_px_per_rad;
  if (!(fineness > 0)) return;
  const Panorama panorama = Panorama::sphere(pixels_around(fineness));
  const Eigen::Vector3d origin = recording.pose(0).world_from_camera.translation();
  const bool is_filtered = recording.events.texture_filter != TextureFilter::kBilinear;
  ImageF radiance(panorama.width, panorama.height);
  Progress progress("panorama", radiance.size(), "pixels");
  parallel_for(static_cast<std::size_t>(panorama.height), [&](std::size_t row) {
    const int y = static_cast<int>(row);
    std::array<Ray, kTilePixels> rays;
    std::array<TriangleId, kTilePixels> triangles;
    const int packet = static_cast<int>(kTilePixels);
    for (int first = 0; first < panorama.width; first += packet) {
      const auto count = static_cast<std::size_t>(std::min(packet, panorama.width - first));
      for (std::size_t k = 0; k < count; ++k)
        rays[k] = {origin, panorama.direction(first + static_cast<int>(k), y), 0};
      recording.scene.visible({rays.data(), count}, {triangles.data(), count});
      for (std::size_t k = 0; k < count; ++k) {
        const int x = first + static_cast<int>(k);
        const Shade shade =
            is_filtered ? recording.scene.shade(rays[k], triangles[k],
                                                {panorama.direction(x + 1, y) - rays[k].direction,
                                                 panorama.direction(x, y + 1) - rays[k].direction})
                        : recording.scene.shade(rays[k], triangles[k]);
        radiance(x, y) = static_cast<float>(shade.radiance);
      }
    }
    progress.add(static_cast<std::size_t>(panorama.width));
  });
  write_exr(recording.writer.folder() / "panorama.exr", radiance, "Y");
}

}  // namespace saccade
