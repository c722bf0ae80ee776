#include "estimator/run/pose_table.h"

#include <cstddef>

#include "core/check.h"

namespace saccade {

CameraPose pose_at(const Trajectory& world_from_camera, const Rigid3& target_from_world,
                   TimeNs t_ns) {
  const Rigid3 pose = target_from_world * world_from_camera.at_clamped(seconds_from_ns(t_ns));
  return {pose.rotation_matrix().cast<float>(), pose.translation().cast<float>()};
}

PoseTable::PoseTable(const Trajectory& world_from_camera, const Rigid3& target_from_world,
                     TimeNs start_ns, TimeNs end_ns)
    : start_ns_(start_ns) {
  SACCADE_CHECK(!world_from_camera.empty() && start_ns <= end_ns);
  const TimeNs count = (end_ns - start_ns) / kPoseIntervalNs + 2;
  for (TimeNs i = 0; i < count; ++i)
    poses_.push_back(pose_at(world_from_camera, target_from_world, start_ns + i * kPoseIntervalNs));
}

CameraPose PoseTable::at(TimeNs t_ns) const {
  const TimeNs since = t_ns - start_ns_;
  const auto i = static_cast<std::size_t>(since / kPoseIntervalNs);
  const float fraction =
      static_cast<float>(since % kPoseIntervalNs) / static_cast<float>(kPoseIntervalNs);
  return between(poses_[i], poses_[i + 1], fraction);
}

}  // namespace saccade
