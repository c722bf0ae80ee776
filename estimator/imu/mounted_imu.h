#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/imu_sample.h"
#include "core/io/dataset/dataset.h"

namespace saccade {

/// Samples of an inertial sensor that is fixed to a camera.
struct MountedImu {
  std::vector<ImuSample> samples;  ///< in the camera's axes, in order of time
  Eigen::Vector3d position_in_camera = Eigen::Vector3d::Zero();  ///< of the sensor [m]
  ImuCalibration noise;
};

/// A dataset's imu.txt, rotated into the camera's axes by camera.yaml, with the noise of imu.yaml
/// or, where it states none, that of a consumer sensor. Throws InputError where the dataset has no
/// samples; `consumer` says in the error who needs them.
[[nodiscard]] MountedImu load_mounted_imu(const Dataset& dataset, const std::string& consumer);

}  // namespace saccade
