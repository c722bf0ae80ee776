#pragma once

#include <span>

#include "core/imu_sample.h"
#include "core/spline/spline.h"

namespace saccade::testing {

/// Where an IMU is and how fast.
struct ImuState {
  Rigid3 world_from_imu;
  Eigen::Vector3d velocity_in_world;  ///< [m/s]
};

/// The true state of an IMU fixed to the moving camera.
[[nodiscard]] ImuState true_imu_state(const Spline& world_from_camera,
                                      const Rigid3& camera_from_imu, double t_s);

/// Dead reckoning from the state at the first sample to that at the last by the midpoint rule:
///   R' = R Exp((w + w') dt / 2),   a = (R f + R' f') / 2 + g,   p' = p + v dt + a dt^2 / 2,
///   v' = v + a dt.
[[nodiscard]] ImuState integrate_midpoint(const ImuState& start, std::span<const ImuSample> samples,
                                          const Eigen::Vector3d& gravity_m_s2);

}  // namespace saccade::testing
