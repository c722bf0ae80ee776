#include "tests/support/imu_integration.h"

namespace saccade::testing {

ImuState true_imu_state(const Spline& world_from_camera, const Rigid3& camera_from_imu,
                        double t_s) {
  const SplineState imu = world_from_camera.state(t_s).attached(camera_from_imu);
  return {imu.world_from_body, imu.velocity_in_world};
}

ImuState integrate_midpoint(const ImuState& start, std::span<const ImuSample> samples,
                            const Eigen::Vector3d& gravity_m_s2) {
  Eigen::Quaterniond rotation = start.world_from_imu.rotation();
  Eigen::Vector3d position = start.world_from_imu.translation();
  Eigen::Vector3d velocity = start.velocity_in_world;
  for (std::size_t k = 0; k + 1 < samples.size(); ++k) {
    const ImuSample& a = samples[k];
    const ImuSample& b = samples[k + 1];
    const double dt = seconds_from_ns(b.t_ns - a.t_ns);
    const Eigen::Quaterniond next =
        (rotation * so3_exp(0.5 * dt * (a.angular_velocity + b.angular_velocity))).normalized();
    const Eigen::Vector3d acceleration =
        0.5 * (rotation * a.specific_force + next * b.specific_force) + gravity_m_s2;
    position += dt * velocity + 0.5 * dt * dt * acceleration;
    velocity += dt * acceleration;
    rotation = next;
  }
  return {{rotation, position}, velocity};
}

}  // namespace saccade::testing
