#include "estimator/imu/imu_input.h"

#include <utility>

#include "core/error.h"
#include "core/io/imu_file.h"

namespace saccade {
namespace {

/// Noise densities of a consumer sensor [rad/s/sqrt(Hz), m/s^2/sqrt(Hz)].
constexpr double kGyroscopeDensity = 1e-3, kAccelerometerDensity = 1e-2;

}  // namespace

ImuInput load_imu_input(const Dataset& dataset, const std::string& consumer) {
  const std::string folder = dataset.folder().string();
  if (!dataset.has_imu())
    throw InputError(folder, "holds no imu.txt, which " + consumer + " needs");
  ImuInput input;
  input.samples = dataset.load_imu();
  if (input.samples.empty())
    throw InputError(folder, "holds an imu.txt without readings; " + consumer + " needs them");
  if (const auto camera_from_imu = dataset.camera_from_imu()) {
    input.camera_from_imu = camera_from_imu->rotation_matrix();
    input.imu_in_camera = camera_from_imu->translation();
  }
  return input;
}

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

ImuPoses camera_orientations(const ImuInput& imu, const OrientationOptions& options) {
  const Eigen::Quaterniond imu_from_camera(Eigen::Matrix3d(imu.camera_from_imu.transpose()));
  ImuPoses result;
  std::vector<StampedPose> poses, continuous;
  poses.reserve(imu.samples.size());
  continuous.reserve(imu.samples.size());
  for (const ImuOrientation& one : estimate_orientations(imu.samples, options)) {
    result.gyro.push_back(one.gyro);
    const double t_s = seconds_from_ns(one.gyro.t_ns);
    const auto add = [&](const Eigen::Quaterniond& orientation, std::vector<StampedPose>& to) {
      to.push_back({t_s, {orientation * imu_from_camera, Eigen::Vector3d::Zero()}});
    };
    add(one.world_from_imu, poses);
    add(one.continuous, continuous);
  }
  result.continuous = Trajectory(std::move(continuous));
  result.world_from_camera = Trajectory(std::move(poses));
  return result;
}

Trajectory gravity_aligned(const Trajectory& world_from_camera, const ImuInput& imu) {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  for (const ImuSample& sample : imu.samples)
    force += world_from_camera.at_clamped(seconds_from_ns(sample.t_ns)).rotation() *
             (imu.camera_from_imu * sample.specific_force);
  // Without an accelerometer, or in free fall, gravity is unknown.
  if (!(force.norm() > 0)) return world_from_camera;
  const auto alignment = Eigen::Quaterniond::FromTwoVectors(force, Eigen::Vector3d::UnitZ());
  std::vector<StampedPose> poses(world_from_camera.poses().begin(),
                                 world_from_camera.poses().end());
  for (StampedPose& pose : poses)
    pose.world_from_camera = Rigid3(alignment, Eigen::Vector3d::Zero()) * pose.world_from_camera;
  return Trajectory(std::move(poses));
}

}  // namespace saccade
