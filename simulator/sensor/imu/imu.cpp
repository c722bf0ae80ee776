#include "simulator/sensor/imu/imu.h"

#include <cmath>

#include "core/check.h"
#include "core/config/rigid3_node.h"
#include "core/random.h"
#include "simulator/sensor/sample_times.h"

namespace saccade {
namespace {

enum class Draw : std::uint64_t { kWhite, kWalk };

/// Streams of their own, far from those of pixels.
std::uint64_t stream_of(ImuTriad triad, Draw draw, int axis) {
  constexpr std::uint64_t kImu = 0x494D55ULL << 40;
  const std::uint64_t kind =
      2 * static_cast<std::uint64_t>(triad) + static_cast<std::uint64_t>(draw);
  return kImu + 3 * kind + static_cast<std::uint64_t>(axis);
}

}  // namespace

std::vector<TriadError> triad_errors(const TriadNoise& noise, const Eigen::Vector3d& turn_on_bias,
                                     double dt_s, std::uint64_t seed, ImuTriad triad,
                                     std::size_t count) {
  SACCADE_CHECK(dt_s > 0);
  const Random random(seed);
  const double white_sigma = noise.density / std::sqrt(dt_s);
  const double walk_sigma = noise.random_walk * std::sqrt(dt_s);
  const auto draw = [&](double sigma, Draw kind, std::size_t k) -> Eigen::Vector3d {
    if (sigma == 0) return Eigen::Vector3d::Zero();
    Eigen::Vector3d v;
    for (int axis = 0; axis < 3; ++axis)
      v[axis] = sigma * random.normal(stream_of(triad, kind, axis), k);
    return v;
  };
  std::vector<TriadError> errors(count);
  Eigen::Vector3d bias = turn_on_bias;
  for (std::size_t k = 0; k < count; ++k) {
    if (k > 0) bias += draw(walk_sigma, Draw::kWalk, k);
    errors[k] = {bias, draw(white_sigma, Draw::kWhite, k)};
  }
  return errors;
}

void describe(config::Fields& fields, ImuOptions& options) {
  fields.value("rate_hz", options.rate_hz, "Number of IMU samples per second. 0 disables the IMU.")
      .range(0, 1e6);
  fields
      .value("T_camera_imu", options.camera_from_imu,
             "Pose as a 4 x 4 matrix: a point in the camera is T times the point in the IMU, in "
             "metres.")
      .range(-1e6, 1e6);
  fields
      .value("gyro_noise_density", options.gyroscope.density,
             "White noise density of the gyroscope, in rad/s/sqrt(Hz). 0 disables it.")
      .range(0, 1e3);
  fields
      .value("gyro_random_walk", options.gyroscope.random_walk,
             "Random walk of the gyroscope bias, in rad/s^2/sqrt(Hz). 0 keeps the bias constant.")
      .range(0, 1e3);
  fields.value("gyro_bias", options.gyro_bias, "Bias of the gyroscope at the start, in rad/s.")
      .range(-1e3, 1e3);
  fields
      .value("accel_noise_density", options.accelerometer.density,
             "White noise density of the accelerometer, in m/s^2/sqrt(Hz). 0 disables it.")
      .range(0, 1e3);
  fields
      .value("accel_random_walk", options.accelerometer.random_walk,
             "Random walk of the accelerometer bias, in m/s^3/sqrt(Hz). 0 keeps the bias constant.")
      .range(0, 1e3);
  fields
      .value("accel_bias", options.accel_bias, "Bias of the accelerometer at the start, in m/s^2.")
      .range(-1e3, 1e3);
}

ImuSample imu_sample(const Spline& motion, const Rigid3& camera_from_imu,
                     const Eigen::Vector3d& gravity_m_s2, TimeNs t_ns) {
  const SplineState imu = motion.state(seconds_from_ns(t_ns)).attached(camera_from_imu);
  const Eigen::Quaterniond imu_from_world = imu.world_from_body.rotation().conjugate();
  return {t_ns, imu_from_world * (imu.acceleration_in_world - gravity_m_s2),
          imu.angular_velocity_in_body};
}

ImuRecording record_imu(const Spline& motion, const ImuOptions& options,
                        const Eigen::Vector3d& gravity_m_s2, std::uint64_t seed) {
  ImuRecording recording;
  if (options.rate_hz <= 0) return recording;
  const std::vector<TimeNs> times = sample_times(options.rate_hz, motion.end_s());
  const double dt_s = 1 / options.rate_hz;
  const std::vector<TriadError> gyro = triad_errors(options.gyroscope, options.gyro_bias, dt_s,
                                                    seed, ImuTriad::kGyroscope, times.size());
  const std::vector<TriadError> accel =
      triad_errors(options.accelerometer, options.accel_bias, dt_s, seed, ImuTriad::kAccelerometer,
                   times.size());
  for (std::size_t k = 0; k < times.size(); ++k) {
    const ImuSample ideal = imu_sample(motion, options.camera_from_imu, gravity_m_s2, times[k]);
    recording.truth.push_back({ideal, accel[k].bias, gyro[k].bias});
    recording.readings.push_back({times[k], ideal.specific_force + accel[k].bias + accel[k].white,
                                  ideal.angular_velocity + gyro[k].bias + gyro[k].white});
  }
  return recording;
}

}  // namespace saccade
