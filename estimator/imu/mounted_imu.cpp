#include "estimator/imu/mounted_imu.h"

#include <filesystem>

#include "core/io/calibration_file.h"
#include "core/io/imu_file.h"
#include "estimator/imu/imu_input.h"

namespace saccade {
namespace {

/// White noise of a sensor of a consumer's grade [rad/s/sqrt(Hz), m/s^2/sqrt(Hz)].
constexpr double kGyroscopeDensity = 1e-3, kAccelerometerDensity = 1e-2;

}  // namespace

MountedImu load_mounted_imu(const Dataset& dataset, const std::string& needs) {
  const ImuInput input = load_imu_input(dataset, needs);
  MountedImu imu;
  for (const ImuSample& sample : input.samples)
    imu.samples.push_back({sample.t_ns, input.camera_from_imu * sample.specific_force,
                           input.camera_from_imu * sample.angular_velocity});
  const std::filesystem::path chain = dataset.folder() / "camera.yaml";
  if (std::filesystem::exists(chain))
    if (const auto camera_from_imu = read_camera_chain(chain).front().camera_from_imu)
      imu.place = camera_from_imu->translation();
  const std::filesystem::path noise = dataset.folder() / "imu.yaml";
  if (std::filesystem::exists(noise)) imu.noise = read_imu_yaml(noise);
  if (imu.noise.gyroscope.density == 0) imu.noise.gyroscope.density = kGyroscopeDensity;
  if (imu.noise.accelerometer.density == 0) imu.noise.accelerometer.density = kAccelerometerDensity;
  return imu;
}

}  // namespace saccade
