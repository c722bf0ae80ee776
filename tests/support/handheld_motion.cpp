#include "tests/support/handheld_motion.h"

#include <cmath>

namespace saccade::testing {

Spline handheld_motion(double duration_s) {
  std::vector<StampedPose> poses;
  for (double t_s = 0; t_s <= duration_s + 1e-9; t_s += 0.05) {
    const Eigen::Vector3d position(0.4 * std::sin(4 * t_s), 0.3 * std::sin(7 * t_s + 1),
                                   0.2 * std::sin(5 * t_s + 2));
    const Eigen::Vector3d rotation(0.3 * std::sin(3 * t_s), 0.2 * std::sin(5 * t_s),
                                   0.4 * std::sin(2 * t_s));
    poses.push_back({t_s, {so3_exp({-1.6, 0, 0}) * so3_exp(rotation), position}});
  }
  return Spline::interpolate(poses);
}

std::vector<ImuSample> imu_readings(const Spline& world_from_camera, const Rigid3& camera_from_imu,
                                    const Eigen::Vector3d& gyro_bias,
                                    const Eigen::Vector3d& accel_bias) {
  constexpr double kRate_hz = 1000;
  std::vector<ImuSample> samples;
  for (int i = 0; i <= static_cast<int>(kRate_hz * world_from_camera.end_s()); ++i) {
    const double t_s = i / kRate_hz;
    const SplineState state = world_from_camera.state(t_s).attached(camera_from_imu);
    ImuSample sample;
    sample.t_ns = ns_from_seconds(t_s);
    sample.angular_velocity = state.angular_velocity_in_body + gyro_bias;
    sample.specific_force =
        state.world_from_body.rotation().conjugate() * (state.acceleration_in_world - kGravity) +
        accel_bias;
    samples.push_back(sample);
  }
  return samples;
}

}  // namespace saccade::testing
