#pragma once

#include <vector>

#include "core/imu_sample.h"
#include "core/spline/spline.h"

namespace saccade::testing {

/// A hand-held camera: half a metre to and fro and rotations of about 20 degrees, at half
/// a hertz to two, from time 0 on; z is up.
[[nodiscard]] Spline handheld_motion(double duration_s);

/// [m/s^2]
inline const Eigen::Vector3d kGravity(0, 0, -9.81);

/// What a sensor fixed to the moving camera reads 1000 times a second, the biases added to it:
/// `camera_from_imu` is where it sits.
[[nodiscard]] std::vector<ImuSample> imu_readings(const Spline& world_from_camera,
                                                  const Rigid3& camera_from_imu,
                                                  const Eigen::Vector3d& gyro_bias,
                                                  const Eigen::Vector3d& accel_bias);

}  // namespace saccade::testing
