#include "simulator/record_images.h"

#include <algorithm>
#include <array>
#include <vector>

#include "core/io/exr_file.h"
#include "core/panorama.h"
#include "core/parallel.h"
#include "core/progress.h"
#include "simulator/exposure.h"
#include "simulator/sensor/sample_times.h"
#include "simulator/sensor/image_renderer.h"

namespace saccade {
namespace {

std::vector<StampedPose> exposure_poses(const Take& take, const ViewRenderer& renderer,
                                        double t_s) {
  std::vector<StampedPose> poses;
  for (const double t :
       exposure_times(renderer, take.world_from_camera, t_s, take.config.frames.exposure_s))
    poses.push_back(take.pose(t));
  return poses;
}

void record_frame(const Take& take, const ViewRenderer& renderer, std::size_t index, double t_s) {
  const ImageF exposed = renderer.radiance(exposure_poses(take, renderer, t_s));
  if (take.config.frames.radiance == FrameOptions::Radiance::kExposed) {
    take.writer.write_frame(index, t_s, exposed);
  } else {
    const std::vector<StampedPose> instant{take.pose(t_s)};
    take.writer.write_frame(index, t_s, exposed, renderer.radiance(instant));
  }
}

}  // namespace

void record_images(const Take& take) {
  const ViewRenderer renderer(take.scene, take.camera, take.events.samples_per_pixel,
                              take.events.texture_filter);
  const GroundtruthOptions& rates = take.config.groundtruth;
  const std::vector<TimeNs> frames = sample_times(take.config.frames.rate_hz, take.duration_s());
  const std::vector<TimeNs> depths =
      merge_times(frames, sample_times(rates.depth_rate_hz, take.duration_s()));
  const std::vector<TimeNs> flows = sample_times(rates.flow_rate_hz, take.duration_s());
  Progress progress("images", frames.size() + depths.size() + flows.size(), "images");
  parallel_for(frames.size(), [&](std::size_t i) {
    const double t = seconds_from_ns(frames[i]);
    if (!take.writer.take_up_frame(i, t)) record_frame(take, renderer, i, t);
    progress.add(1);
  });
  parallel_for(depths.size(), [&](std::size_t i) {
    const double t = seconds_from_ns(depths[i]);
    if (!take.writer.take_up_depth(i, t))
      take.writer.write_depth(i, t, renderer.depth(take.pose(t)));
    progress.add(1);
  });
  parallel_for(flows.size(), [&](std::size_t i) {
    const double t = seconds_from_ns(flows[i]);
    if (!take.writer.take_up_flow(i, t))
      take.writer.write_flow(i, t, renderer.flow(take.world_from_camera.state(t), t));
    progress.add(1);
  });
}

void record_panorama(const Take& take) {
  const double fineness = take.config.groundtruth.panorama_px_per_rad;
  if (!(fineness > 0)) return;
  const Panorama panorama = Panorama::sphere(pixels_around(fineness));
  const Eigen::Vector3d origin = take.pose(0).world_from_camera.translation();
  const bool is_filtered = take.events.texture_filter != TextureFilter::kBilinear;
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
      take.scene.visible({rays.data(), count}, {triangles.data(), count});
      for (std::size_t k = 0; k < count; ++k) {
        const int x = first + static_cast<int>(k);
        const Shade shade =
            is_filtered ? take.scene.shade(rays[k], triangles[k],
                                           {panorama.direction(x + 1, y) - rays[k].direction,
                                            panorama.direction(x, y + 1) - rays[k].direction})
                        : take.scene.shade(rays[k], triangles[k]);
        radiance(x, y) = static_cast<float>(shade.radiance);
      }
    }
    progress.add(static_cast<std::size_t>(panorama.width));
  });
  write_exr(take.writer.folder() / "panorama.exr", radiance, "Y");
}

}  // namespace saccade
