#pragma once

#include <algorithm>
#include <vector>

#include "core/spline/spline.h"
#include "simulator/camera_recording.h"
#include "simulator/sensor/image_renderer.h"

namespace saccade {

/// An exposure of `exposure_s` centred on `t_s` and cut to the motion's span.
struct Exposure {
  double from_s, to_s;

  Exposure(const Spline& world_from_camera, double t_s, double exposure_s)
      : from_s(std::max(world_from_camera.start_s(), t_s - 0.5 * exposure_s)),
        to_s(std::min(world_from_camera.end_s(), t_s + 0.5 * exposure_s)) {}
  [[nodiscard]] double length_s() const { return to_s - from_s; }
};

/// The instants whose views average to the frame at `t_s`: the midpoints of equal parts of the
/// exposure, which is centred on `t_s` and cut to the motion's span; as many as keep the image
/// motion between two of them below a quarter of a pixel, but at most 256 (so a blur beyond 64 px
/// is coarser). Just `t_s` where `exposure_s` is 0.
[[nodiscard]] std::vector<double> exposure_times(const ImageRenderer& renderer,
                                                 const Spline& world_from_camera, double t_s,
                                                 double exposure_s);

/// Writes frames, depth maps and motion fields, in parallel; those that an interrupted program left
/// behind complete are kept.
void record_images(const CameraRecording& recording);

/// Writes panorama.exr where it is asked for: linear radiance in all directions of the world as the
/// camera's position sees them at time 0, the whole sphere of core/panorama.h.
void record_panorama(const CameraRecording& recording);

}  // namespace saccade
