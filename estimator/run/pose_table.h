#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/event.h"
#include "core/rigid3.h"
#include "core/trajectory.h"

namespace saccade {

/// p_target = r p_camera + t.
struct CameraPose {
  Eigen::Matrix3f r;
  Eigen::Vector3f t;
};

/// target_from_camera, held beyond the trajectory's ends.
[[nodiscard]] CameraPose pose_at(const Trajectory& world_from_camera,
                                 const Rigid3& target_from_world, TimeNs t_ns);

/// Linear interpolation between nearby poses.
[[nodiscard]] inline CameraPose between(const CameraPose& from, const CameraPose& to,
                                        float fraction) {
  return {from.r + fraction * (to.r - from.r), from.t + fraction * (to.t - from.t)};
}

/// Between exact poses: at 10 rad/s the error of a linearly interpolated rotation is 5e-7.
inline constexpr TimeNs kPoseIntervalNs = 200'000;

/// target_from_camera at the time of any event: exact every kPoseIntervalNs and linear in between.
class PoseTable {
 public:
  /// From `start_ns` to `end_ns`, held beyond the trajectory's ends.
  PoseTable(const Trajectory& world_from_camera, const Rigid3& target_from_world, TimeNs start_ns,
            TimeNs end_ns);

  /// `t_ns` within the table.
  [[nodiscard]] CameraPose at(TimeNs t_ns) const;

 private:
  TimeNs start_ns_;
  std::vector<CameraPose> poses_;
};

}  // namespace saccade
