#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/imu_sample.h"
#include "core/io/dataset/dataset.h"

namespace saccade {

/// An inertial sensor that is fixed to a camera.
struct MountedImu {
  std::vector<ImuSample> samples;                   ///< in the camera's axes, in order of time
  Eigen::Vector3d place = Eigen::Vector3d::Zero();  ///< of the sensor in the camera's frame [m]
  ImuCalibration noise;
};

/// A dataset's imu.txt, turned into the camera's axes by camera.yaml, with the noise of imu.yaml
/// or, where there is none or it states none, that of a sensor of a consumer's grade. Throws
/// InputError where the dataset has no readings; `needs` is who needs them.
[[nodiscard]] MountedImu load_mounted_imu(const Dataset& dataset, const std::string& needs);

}  // namespace saccade
