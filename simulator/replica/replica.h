#pragma once

#include <filesystem>

#include "core/camera.h"
#include "core/image.h"
#include "core/trajectory.h"

namespace saccade {

/// What a replica of a recording is made from: one of its frames, hung as a picture on a plane before
/// the recorded camera, which repeats the recorded motion.
struct ReplicaSource {
  ImageF radiance;          ///< of the frame, linear, camera height x width
  double noise = 0;         ///< standard deviation of the frame's noise, smoothed away; 0: none
  PinholeCamera camera;     ///< with its lens
  Rigid3 world_from_frame;  ///< of the camera when the frame was exposed
  double depth_m = 1;  ///< z of the plane from there, > 0; without effect where the camera rotates
  /// World from camera on the recording's clock; two poses at least, spans the part.
  Trajectory motion;
  bool smooths_motion = false;  ///< as recorded poses, whose jitter is no motion, want it
  double start_s = 0;           ///< of the part, on the recording's clock
  double duration_s = 0;        ///< > 0
  double log_eps = 1e-3;        ///< see EventOptions
  /// For so long before the part the simulation runs already, >= 0: a pixel that has just fired
  /// stands elsewhere between its thresholds than one before a scene that was still. Where the motion
  /// begins later, it is extrapolated at constant velocity.
  double warm_up_s = 0;
};

/// Writes simulation.yaml, the scene and the motion that it names, and calib.txt into `folder`, for
/// `saccade simulate`; its time 0 is warm_up_s before the part. The events' sensor is ideal. Edges are as sharp as in the frame; what is
/// beyond its borders is its mirror image.
void write_replica(const ReplicaSource& source, const std::filesystem::path& folder);

/// 1 at the pixels that see no place beyond the frame's borders during the part, within
/// `margin_px` of them: where the replica can be compared; 0 elsewhere.
[[nodiscard]] ImageU8 comparable_pixels(const ReplicaSource& source, double margin_px = 2);

/// Standard deviation of the noise of a frame, from its flattest parts [its unit]: the 5 % quantile
/// of the local one. An upper bound where texture is everywhere.
[[nodiscard]] double frame_noise(const ImageF& radiance);

}  // namespace saccade
