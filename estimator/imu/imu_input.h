#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/imu_sample.h"
#include "core/io/dataset/dataset.h"
#include "core/trajectory.h"
#include "estimator/imu/orientation.h"

namespace saccade {

/// The readings of a dataset's inertial sensor.
struct ImuInput {
  std::vector<ImuSample> samples;  ///< at least one, in the sensor's frame
  Eigen::Matrix3d camera_from_imu = Eigen::Matrix3d::Identity();  ///< camera.yaml's
};

/// Throws InputError where the dataset has no readings; `needs` is who needs them.
[[nodiscard]] ImuInput load_imu_input(const Dataset& dataset, const std::string& needs);

/// What a filter makes of them.
struct ImuPoses {
  Trajectory world_from_camera;        ///< at every reading, at the origin
  std::vector<GyroBiasEstimate> gyro;  ///< as many
};

/// The orientations turned as one, so that the mean force over all readings points up: of a sensor
/// that is not carried about it is gravity's. `world_from_camera` spans the readings' time.
[[nodiscard]] Trajectory levelled(const Trajectory& world_from_camera, const ImuInput& imu);

[[nodiscard]] ImuPoses camera_orientations(const ImuInput& imu, const OrientationOptions& options);

}  // namespace saccade
