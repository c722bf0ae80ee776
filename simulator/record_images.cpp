#include "simulator/record_images.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/parallel.h"
#include "core/progress.h"
#include "simulator/sensor/sample_times.h"
#include "simulator/sensor/view.h"

namespace saccade {
namespace {

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

}  // namespace

void record_images(const Take& take) {
  const ViewRenderer renderer(take.scene, take.camera, take.events.samples_per_pixel);
  const GroundtruthOptions& rates = take.config.groundtruth;
  const std::vector<TimeNs> frames = sample_times(take.config.frames.rate_hz, take.duration_s());
  const std::vector<TimeNs> depths =
      merge_times(frames, sample_times(rates.depth_rate_hz, take.duration_s()));
  const std::vector<TimeNs> flows = sample_times(rates.flow_rate_hz, take.duration_s());
  Progress progress("images", frames.size() + depths.size() + flows.size(), "images");
  parallel_for(frames.size(), [&](std::size_t i) {
    const double t = seconds_from_ns(frames[i]);
    if (!take.writer.take_up_frame(i, t))
      take.writer.write_frame(i, t, renderer.radiance(exposure_poses(take, renderer, t)));
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
