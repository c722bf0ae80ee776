#pragma once

#include "simulator/camera_recording.h"

namespace saccade {

/// Writes frames, depth maps and motion fields, in parallel; those that an interrupted program left
/// behind complete are kept.
void record_images(const CameraRecording& recording);

/// Writes panorama.exr where it is asked for: linear radiance in all directions of the world as the
/// camera's position sees them at time 0, the whole sphere of core/panorama.h.
void record_panorama(const CameraRecording& recording);

}  // namespace saccade
