#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/imu_sample.h"
#include "core/io/dataset.h"

namespace saccade {

/// The readings of a dataset's inertial sensor.
struct ImuInput {
  std::vector<ImuSample> samples;  ///< at least one, in the sensor's frame
  Eigen::Matrix3d camera_from_imu = Eigen::Matrix3d::Identity();  ///< camera.yaml's
};

/// Throws InputError where the dataset has no readings; `needs` is who needs them.
[[nodiscard]] ImuInput load_imu_input(const Dataset& dataset, const std::string& needs);

}  // namespace saccade
