#include "estimator/imu/inertial_alignment.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.h"
#include "tests/support/handheld_motion.h"

namespace saccade {
namespace {

using testing::kGravity;
using Status = InertialAlignment::Status;

constexpr double kScale = 2.5;
constexpr double kEnd_s = 6;
const Rigid3 kPathFromWorld(so3_exp({0.4, -0.7, 0.2}), {1, 2, 3});
const ImuBias kBias{{0.05, -0.05, 0.05}, {0.1, 0.05, -0.1}};

/// A motion in a world of its own, where lengths are metres over kScale; poses are off by
/// `position_m` and `turn_rad`.
Trajectory path_of(const Spline& motion, double position_m = 0, double turn_rad = 0) {
  std::vector<StampedPose> poses;
  for (std::uint64_t i = 0; i <= static_cast<std::uint64_t>(motion.end_s() / 2e-3); ++i) {
    const double t_s = 2e-3 * static_cast<double>(i);
    const auto draw = [i](std::uint64_t k) { return Random(1).normal(k, i); };
    Rigid3 pose = kPathFromWorld * motion.pose(t_s);
    const Eigen::Vector3d off(draw(0), draw(1), draw(2));
    const Eigen::Vector3d turned(draw(3), draw(4), draw(5));
    poses.push_back({t_s,
                     {pose.rotation() * so3_exp(turn_rad * turned),
                      (pose.translation() + position_m * off) / kScale}});
  }
  return Trajectory(std::move(poses));
}

MountedImu sensor_on(const Spline& motion, const Eigen::Vector3d& place = {0, 0, 0}) {
  MountedImu imu;
  imu.samples = testing::imu_readings(motion, {Eigen::Quaterniond::Identity(), place}, kBias.gyro,
                                      kBias.accel);
  imu.position_in_camera = place;
  imu.noise = {1000, {1e-2, 0}, {1e-3, 0}};
  return imu;
}

TEST(InertialAlignment, FindsWhatAPerfectPathHides) {
  const Spline motion = testing::handheld_motion(kEnd_s);
  const MountedImu imu = sensor_on(motion, {0.05, -0.03, 0.1});
  const InertialAlignment found = align_inertially(path_of(motion), imu, 0.5);
  ASSERT_EQ(found.status, Status::kOk);
  EXPECT_NEAR(found.scale, kScale, 1e-3 * kScale);
  const Eigen::Vector3d gravity = kPathFromWorld.rotation() * kGravity;
  EXPECT_LT((found.gravity - gravity).norm(), 5e-3);
  EXPECT_LT((found.bias.gyro - kBias.gyro).norm(), 1e-4);
  EXPECT_LT((found.bias.accel - kBias.accel).norm(), 5e-3);
  EXPECT_NEAR(found.time_offset_s, 0, 1e-5);
  EXPECT_LT((found.gravity_alignment() * gravity - kGravity).norm(), 5e-3);
}

TEST(InertialAlignment, TellsHowWellItKnowsTheScaleOfANoisyPath) {
  const Spline motion = testing::handheld_motion(kEnd_s);
  MountedImu imu = sensor_on(motion);
  for (std::size_t i = 0; i < imu.samples.size(); ++i) {
    const auto draw = [i](std::uint64_t k) { return Random(2).normal(k, i); };
    const Eigen::Vector3d w(draw(0), draw(1), draw(2));
    const Eigen::Vector3d f(draw(3), draw(4), draw(5));
    imu.samples[i].angular_velocity += 1e-3 * std::sqrt(1000) * w;
    imu.samples[i].specific_force += 1e-2 * std::sqrt(1000) * f;
  }
  const InertialAlignment found = align_inertially(path_of(motion, 5e-3, 5e-3), imu, 0.5);
  ASSERT_EQ(found.status, Status::kOk);
  EXPECT_LT(found.scale_sigma, 0.01);
  EXPECT_LT(std::abs(found.scale / kScale - 1), 3 * found.scale_sigma);
  EXPECT_LT((found.bias.gyro - kBias.gyro).norm(), 3e-3);
  const double tilt =
      std::acos(found.gravity.normalized().dot(kPathFromWorld.rotation() * kGravity.normalized()));
  EXPECT_LT(tilt, 3 * std::sqrt(2) * found.tilt_sigma_rad);
}

TEST(InertialAlignment, FindsTheOffsetOfTheSensorsClock) {
  const Spline motion = testing::handheld_motion(kEnd_s);
  MountedImu imu = sensor_on(motion);
  for (ImuSample& sample : imu.samples) sample.t_ns -= 12'000'000;
  const InertialAlignment found = align_inertially(path_of(motion), imu, 0.5);
  ASSERT_EQ(found.status, Status::kOk);
  EXPECT_NEAR(found.time_offset_s, 0.012, 1e-4);
  EXPECT_NEAR(found.scale, kScale, 2e-3 * kScale);
}

TEST(InertialAlignment, AnEvenMotionHasNoScale) {
  std::vector<StampedPose> poses;
  for (int i = 0; i <= 60; ++i)
    poses.push_back({0.1 * i, {so3_exp({-1.6, 0, 0.02 * i}), {0.05 * i, 0.02 * i, 0}}});
  const Spline motion = Spline::interpolate(poses);
  EXPECT_EQ(align_inertially(path_of(motion, 1e-3), sensor_on(motion), 0.5).status,
            Status::kUnobservableScale);
}

TEST(InertialAlignment, APathThatWasNotFeltDisagrees) {
  const Spline motion = testing::handheld_motion(kEnd_s);
  const Trajectory path = path_of(motion);
  std::vector<StampedPose> poses(path.poses().begin(), path.poses().end());
  for (StampedPose& pose : poses) {
    const Eigen::Vector3d place = pose.world_from_camera.translation();
    pose.world_from_camera = {pose.world_from_camera.rotation(), {place.y(), -place.x(), 0}};
  }
  const InertialAlignment found =
      align_inertially(Trajectory(std::move(poses)), sensor_on(motion), 0.5);
  EXPECT_EQ(found.status, Status::kInconsistent);
  EXPECT_GT(found.residual, 2);
}

TEST(InertialAlignment, NeedsReadings) {
  const Spline motion = testing::handheld_motion(2);
  MountedImu imu = sensor_on(motion);
  imu.samples.resize(500);
  EXPECT_EQ(align_inertially(path_of(motion), imu, 0.5).status, Status::kNoSamples);
}

}  // namespace
}  // namespace saccade
