#include "simulator/record_images.h"

#include <vector>

#include "core/parallel.h"
#include "core/progress.h"
#include "simulator/exposure.h"
#include "simulator/sensor/sample_times.h"
#include "simulator/sensor/view.h"

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

}  // namespace saccade
