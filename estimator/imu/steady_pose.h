#pragma once

#include <Eigen/Geometry>

#include "core/trajectory.h"

namespace saccade {

struct SteadyPoseOptions {
  double time_constant_s = 0.4;  ///< tau: alpha of (3.18) is 1 - exp(-dt / tau), 0.1 at 24 Hz
  bool lock_roll = false;        ///< the picture's rows are kept level
  double max_angle_deg = 20;     ///< farther from the camera the steady pose is dragged along
};

/// The orientation that pictures are turned to (thesis 3.2): the camera's, low-pass filtered,
///   q_s <- Slerp(q_s, q_k, alpha) = (q_k q_s^-1)^alpha q_s                                 (3.18)
/// at every orientation that is given, in order of time. (The thesis prints (q_s q_k^-1)^alpha q_s,
/// which moves away from q_k.) Starts at the first of them. The result has the same times;
/// positions are zero.
[[nodiscard]] Trajectory steady_poses(const Trajectory& world_from_camera,
                                      const SteadyPoseOptions& options);

/// The same viewing direction with the camera's x axis (its rows) level and y pointing down; where
/// the camera looks up or down within 10 degrees, less and less of that turn.
[[nodiscard]] Eigen::Quaterniond without_roll(const Eigen::Quaterniond& world_from_camera);

}  // namespace saccade
