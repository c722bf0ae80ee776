#include "estimator/imu/mounted_imu.h"

#include <filesystem>

#include "core/io/imu_file.h"
#include "estimator/imu/imu_input.h"

namespace saccade {
namespace {

/// Noise densities of a consumer sensor [rad/s/sqrt(Hz), m/s^2/sqrt(Hz)].
constexpr double kGyroscopeDensity = 1e-3, kAccelerometerDensity = 1e-2;

}  // namespace

MountedImu load_mounted_imu(const Dataset& dataset, const std::string& consumer) {
  const ImuInput input = load_imu_input(dataset, consumer);
  MountedImu imu;
  for (const ImuSample& sample : input.samples)
    imu.samples.push_back({sample.t_ns, input.camera_from_imu * sample.specific_force,
                           input.camera_from_imu * sample.angular_velocity});
  imu.position_in_camera = input.imu_in_camera;
  const std::filesystem::path noise = dataset.folder() / "imu.yaml";
  if (std::filesystem::exists(noise)) imu.noise = read_imu_yaml(noise);
  if (imu.noise.gyroscope.density == 0) imu.noise.gyroscope.density = kGyroscopeDensity;
  if (imu.noise.accelerometer.density == 0) imu.noise.accelerometer.density = kAccelerometerDensity;
  return imu;
}

}  // namespace saccade
