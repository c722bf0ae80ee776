#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/imu_sample.h"
#include "core/io/dataset/dataset.h"
#include "core/trajectory.h"
#include "estimator/imu/orientation.h"

namespace saccade {

/// A dataset's imu.txt, and where camera.yaml places the sensor (in the camera's frame, without a
/// camera.yaml).
struct ImuInput {
  std::vector<ImuSample> samples;  ///< at least one, in the sensor's frame
  Eigen::Matrix3d camera_from_imu = Eigen::Matrix3d::Identity();
  Eigen::Vector3d imu_in_camera = Eigen::Vector3d::Zero();  ///< position of the sensor [m]
};

/// Throws InputError where the dataset has no samples; `consumer` says in the error who needs them.
[[nodiscard]] ImuInput load_imu_input(const Dataset& dataset, const std::string& consumer);

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

/// Orientations of the camera, one per sample.
struct ImuPoses {
  Trajectory world_from_camera;        ///< at the origin
  Trajectory continuous;               ///< the same without jumps, for what is moved by it
  std::vector<GyroBiasEstimate> gyro;  ///< as many
};

[[nodiscard]] ImuPoses camera_orientations(const ImuInput& imu, const OrientationOptions& options);

/// The orientations after one rotation of the world that makes the mean specific force of all
/// samples point up: over a motion that stays in place this is gravity. `world_from_camera` spans
/// the samples' time.
[[nodiscard]] Trajectory gravity_aligned(const Trajectory& world_from_camera, const ImuInput& imu);

}  // namespace saccade
