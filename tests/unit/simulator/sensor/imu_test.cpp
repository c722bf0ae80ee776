#include "simulator/sensor/imu.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/config/config.h"
#include "tests/support/error_of.h"

namespace saccade {
namespace {

using Eigen::Vector3d;
using testing::error_of;
using ::testing::HasSubstr;

Spline at_rest(const Eigen::Quaterniond& rotation) {
  return Spline::from_control_poses(std::vector<Rigid3>(4, Rigid3(rotation, {1, 2, 3})), 0, 1);
}

/// A lively motion of 2 s.
Spline in_motion() {
  std::vector<StampedPose> poses;
  for (int i = 0; i <= 220; ++i) {
    const double t = 0.01 * i - 0.1;
    poses.push_back({t,
                     {so3_exp({0.8 * std::sin(3 * t), std::sin(2 * t), t}),
                      {std::sin(4 * t), 0.3 * std::cos(5 * t), t * t}}});
  }
  return Spline::interpolate(poses).cut(0, 2);
}

const Rigid3 kCameraFromImu(so3_exp({0.3, -0.5, 1.2}), {0.1, -0.05, 0.2});

TEST(Imu, ReadsGravityUpwardsAtRest) {
  const auto samples = imu_samples(at_rest(Eigen::Quaterniond::Identity()), {}, kStandardGravity);
  ASSERT_EQ(samples.size(), 1001u);
  EXPECT_EQ(samples[1].t_ns, 1'000'000);
  for (const ImuSample& s : samples) {
    EXPECT_LT((s.specific_force - Vector3d(0, 0, 9.81)).norm(), 1e-12);
    EXPECT_LT(s.angular_velocity.norm(), 1e-12);
  }
}

TEST(Imu, ReadsGravityInItsOwnFrame) {
  // A level camera (z forward along +y, y down): up is -y.
  const Spline motion = at_rest(so3_exp({-std::numbers::pi / 2, 0, 0}));
  const ImuSample camera = imu_sample(motion, Rigid3(), kStandardGravity, 0);
  EXPECT_LT((camera.specific_force - Vector3d(0, -9.81, 0)).norm(), 1e-12);
  const ImuSample imu = imu_sample(motion, kCameraFromImu, {0, 0, -1.6}, 0);
  const Vector3d expected = kCameraFromImu.rotation().conjugate() * Vector3d(0, -1.6, 0);
  EXPECT_LT((imu.specific_force - expected).norm(), 1e-12);
}

TEST(Imu, LeverArmFeelsTheCentripetalAcceleration) {
  std::vector<StampedPose> poses;
  for (int i = 0; i <= 100; ++i)
    poses.push_back({0.01 * i, {so3_exp({0, 0, 0.03 * i}), Vector3d::Zero()}});
  const Rigid3 arm(Eigen::Quaterniond::Identity(), {0.5, 0, 0});
  const ImuSample s = imu_sample(Spline::interpolate(poses), arm, Vector3d::Zero(), 500'000'000);
  EXPECT_LT((s.angular_velocity - Vector3d(0, 0, 3)).norm(), 1e-9);
  EXPECT_LT((s.specific_force - Vector3d(-0.5 * 9, 0, 0)).norm(), 1e-6);
}

TEST(Imu, IntegratesBackToTheTrajectory) {
  const Spline motion = in_motion();
  const ImuOptions options{.rate_hz = 1000, .camera_from_imu = kCameraFromImu};
  const auto samples = imu_samples(motion, options, kStandardGravity);
  ASSERT_EQ(samples.size(), 2001u);
  const SplineState start = motion.state(0);
  const Rigid3 world_from_imu = start.world_from_body * kCameraFromImu;
  Eigen::Quaterniond rotation = world_from_imu.rotation();
  Vector3d position = world_from_imu.translation();
  Vector3d velocity = start.velocity_in_world +
                      start.world_from_body.rotation() *
                          start.angular_velocity_in_body.cross(kCameraFromImu.translation());
  for (std::size_t i = 0; i + 1 < samples.size(); ++i) {
    const double dt = 1e-3;
    const ImuSample& a = samples[i];
    const ImuSample& b = samples[i + 1];
    const Eigen::Quaterniond next =
        rotation * so3_exp(0.5 * dt * (a.angular_velocity + b.angular_velocity));
    const Vector3d before = rotation * a.specific_force + kStandardGravity;
    const Vector3d after = next * b.specific_force + kStandardGravity;
    position += dt * velocity + dt * dt * (2 * before + after) / 6;
    velocity += 0.5 * dt * (before + after);
    rotation = next;
  }
  const Rigid3 truth = motion.pose(2) * kCameraFromImu;
  EXPECT_LT((position - truth.translation()).norm(), 1e-4);
  EXPECT_LT(angle_between(rotation, truth.rotation()), 1e-5);
}

ImuOptions options_of(const std::string& yaml) {
  return config::read<ImuOptions>(config::parse(yaml, "a.yaml"));
}

TEST(Imu, OptionsReadAndPrintTheExtrinsics) {
  const ImuOptions options = options_of(
      "rate_hz: 200\n"
      "T_camera_imu: [[0, -1, 0, 0.1], [1, 0, 0, 0.2], [0, 0, 1, 0.3], [0, 0, 0, 1]]\n");
  EXPECT_EQ(options.rate_hz, 200);
  EXPECT_LT((options.camera_from_imu * Vector3d(1, 0, 0) - Vector3d(0.1, 1.2, 0.3)).norm(), 1e-12);
  const ImuOptions again = options_of(config::print(options));
  EXPECT_LT((again.camera_from_imu.inverse() * options.camera_from_imu).log().norm(), 1e-14);
  EXPECT_TRUE(imu_samples(in_motion(), options_of("rate_hz: 0"), kStandardGravity).empty());
}

TEST(Imu, ExtrinsicsMustBeRigid) {
  const auto error = error_of([] {
    return options_of("T_camera_imu: [[2, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]");
  });
  EXPECT_THAT(error, AllOf(HasSubstr("a.yaml:1"), HasSubstr("T_camera_imu"), HasSubstr("rigid")));
}

}  // namespace
}  // namespace saccade
