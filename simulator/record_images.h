#pragma once

#include <vector>

#include "core/spline/spline.h"
#include "simulator/camera_recording.h"
#include "simulator/sensor/image_renderer.h"

namespace saccade {

/// The instants whose views average to the frame at `t_s`: the midpoints of equal parts of the
/// exposure, which is centred on `t_s` and cut to the motion's span; as many as keep the image
/// motion between two of them below a quarter of a pixel, but at most 256 (so a blur beyond 64 px
/// is coarser). Just `t_s` where `exposure_s` is 0.
[[nodiscard]] std::vector<double> exposure_times(const ImageRenderer& renderer,
                                                 const Spline& world_from_camera, double t_s,
                                                 double exposure_s);

/// The exposures of the rows of the frame at `t_s`. With a rolling shutter row y of H is exposed
/// around
///   t_s + (y / (H - 1) - 1/2) readout_s
/// each as exposure_times() has it, all with the same number of views; what would be outside of the
/// motion's span is exposed at its end.
[[nodiscard]] std::vector<RowExposure> row_exposures(const ImageRenderer& renderer,
                                                     const Spline& world_from_camera, double t_s,
                                                     double exposure_s, double readout_s);

/// Writes frames, depth maps and motion fields, in parallel; those that an interrupted program left
/// behind complete are kept.
void record_images(const CameraRecording& recording);

/// Writes panorama.exr where it is asked for: linear radiance in all directions of the world as the
/// camera's position sees them at time 0, the whole sphere of core/panorama.h.
void record_panorama(const CameraRecording& recording);

}  // namespace saccade
