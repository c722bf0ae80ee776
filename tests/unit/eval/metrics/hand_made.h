#pragma once

#include <vector>

#include "core/trajectory.h"

namespace saccade::testing {

/// Along +x at `speed_m_s` from the origin, a pose every `step_s` from `start_s` to `end_s`.
inline Trajectory straight(double start_s, double end_s, double step_s, double speed_m_s = 1,
                           const Eigen::Vector3d& offset = Eigen::Vector3d::Zero()) {
  std::vector<StampedPose> poses;
  const auto steps = static_cast<int>((end_s - start_s) / step_s + 0.5);
  for (int i = 0; i <= steps; ++i) {
    const double t_s = start_s + i * step_s;
    poses.push_back({t_s, Rigid3(Eigen::Quaterniond::Identity(),
                                 Eigen::Vector3d(speed_m_s * t_s, 0, 0) + offset)});
  }
  return Trajectory(std::move(poses));
}

inline Trajectory joined(const Trajectory& a, const Trajectory& b) {
  std::vector<StampedPose> poses(a.poses().begin(), a.poses().end());
  poses.insert(poses.end(), b.poses().begin(), b.poses().end());
  return Trajectory(std::move(poses));
}

}  // namespace saccade::testing
