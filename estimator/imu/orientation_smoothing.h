#pragma once

#include <Eigen/Geometry>

#include "core/trajectory.h"

namespace saccade {

struct SmoothingOptions {
  double time_constant_s = 0.4;  ///< tau: alpha of (3.18) is 1 - exp(-dt / tau), 0.1 at 24 Hz
  bool lock_roll = false;
  double max_angle_deg = 20;
};

/// The steady orientation that pictures are rotated to (thesis 3.2): that of the camera after a
/// low-pass filter,
///   q_s <- Slerp(q_s, q_k, alpha) = (q_k q_s^-1)^alpha q_s                                 (3.18)
/// once for every pose, in order of time. (The thesis prints (q_s q_k^-1)^alpha q_s, which moves
/// away from q_k.) Starts at the first pose. The result has the same times and zero positions.
[[nodiscard]] Trajectory smoothed_orientations(const Trajectory& world_from_camera,
                                               const SmoothingOptions& options);

/// The same viewing direction with the camera's x axis (the rows of the image) horizontal and y
/// pointing down. Within 10 degrees of the vertical the correction fades to none.
[[nodiscard]] Eigen::Quaterniond without_roll(const Eigen::Quaterniond& world_from_camera);

}  // namespace saccade
