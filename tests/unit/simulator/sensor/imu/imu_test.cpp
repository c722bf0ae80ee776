#include "simulator/sensor/imu/imu.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "core/config/config.h"
#include "core/io/imu_file.h"
#include "simulator/motion/motion.h"
#include "tests/support/command.h"
#include "tests/support/error_of.h"
#include "tests/support/imu_integration.h"

namespace saccade {
namespace {

using Eigen::Vector3d;
using testing::error_of;
using ::testing::HasSubstr;
using testing::ImuState;
using testing::integrate_midpoint;
using testing::TemporaryFolder;
using testing::true_imu_state;

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
  const auto samples =
      record_imu(at_rest(Eigen::Quaterniond::Identity()), {}, kStandardGravity, 1).readings;
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

TEST(Imu, LeverArmAgreesWithFiniteDifferencesOfItsPath) {
  const Spline motion = in_motion();
  const Spline imu = motion.attached(kCameraFromImu);
  constexpr double h = 1e-4;
  for (const double t : {0.313, 0.777, 1.514}) {
    const Vector3d p = imu.pose(t).translation();
    const Vector3d before = imu.pose(t - h).translation();
    const Vector3d after = imu.pose(t + h).translation();
    const Vector3d force = (after - 2 * p + before) / (h * h) - kStandardGravity;
    const ImuSample s = imu_sample(motion, kCameraFromImu, kStandardGravity, ns_from_seconds(t));
    EXPECT_LT((imu.pose(t).rotation() * s.specific_force - force).norm(), 1e-3);
  }
}

/// Where dead reckoning over 10 s ends, seen from the truth, from what the file imu.txt holds.
Rigid3 integration_error(const std::string& trajectory_yaml, double rate_hz) {
  const Spline motion =
      build_motion(config::read<MotionOptions>(config::parse(trajectory_yaml, "test.yaml")));
  const ImuOptions options{.rate_hz = rate_hz, .camera_from_imu = kCameraFromImu};
  const TemporaryFolder folder;
  write_imu(folder.path() / "imu.txt", record_imu(motion, options, kStandardGravity, 1).readings);
  const std::vector<ImuSample> readings = read_imu(folder.path() / "imu.txt");
  EXPECT_EQ(readings.back().t_ns, 10'000'000'000);
  const ImuState start = true_imu_state(motion, kCameraFromImu, 0);
  const ImuState truth = true_imu_state(motion, kCameraFromImu, 10);
  const ImuState end = integrate_midpoint(start, readings, kStandardGravity);
  return truth.world_from_imu.inverse() * end.world_from_imu;
}

double degrees(const Rigid3& error) {
  return angle_between(error.rotation(), Eigen::Quaterniond::Identity()) * 180 / std::numbers::pi;
}

TEST(Imu, IntegratesBackToTheTrajectory) {
  for (const char* trajectory :
       {"{source: random_6dof, duration_s: 10}",
        "{source: lissajous, duration_s: 10, rotation_amplitude_deg: [20, 15, 30], "
        "rotation_frequency_hz: [1, 0.7, 0.4]}",
        "{source: lissajous, duration_s: 10, amplitude_m: [0.81, 0.44, 0.5], frequency_hz: [0.5, "
        "0.5, 1.0], rotation_amplitude_deg: [4, 6, 7], rotation_frequency_hz: [1, 0.5, 0.5]}"}) {
    const Rigid3 error = integration_error(trajectory, 1000);
    EXPECT_LT(error.translation().norm(), 1e-3) << trajectory;
    EXPECT_LT(degrees(error), 0.01) << trajectory;
  }
}

// What is left is the midpoint rule's own error: each step turns by w x w' dt^3 / 12 too little,
// and the tilt that adds up lets gravity leak into the position. It falls with the square of the
// rate, and of the frequencies of the motion.
TEST(Imu, TheErrorOfTheMidpointRuleFallsWithTheSquareOfTheRate) {
  const std::string fast =
      "{source: lissajous, duration_s: 10, rotation_amplitude_deg: [40, 30, 60], "
      "rotation_frequency_hz: [2, 1.7, 1.4]}";
  double before = integration_error(fast, 1000).translation().norm();
  for (const double rate_hz : {2000.0, 4000.0}) {
    const double after = integration_error(fast, rate_hz).translation().norm();
    EXPECT_NEAR(before / after, 4, 0.2);
    before = after;
  }
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
  EXPECT_TRUE(
      record_imu(in_motion(), options_of("rate_hz: 0"), kStandardGravity, 1).readings.empty());
}

TEST(Imu, OptionsReadKalibrsNoise) {
  const ImuOptions options = options_of(
      "gyro_noise_density: 0.001\ngyro_random_walk: 1e-5\ngyro_bias: [0.1, 0, -0.1]\n"
      "accel_noise_density: 0.02\naccel_random_walk: 1e-4\naccel_bias: [0, 0.5, 0]\n");
  EXPECT_EQ(options.gyroscope.density, 0.001);
  EXPECT_EQ(options.gyro_bias.z(), -0.1);
  EXPECT_EQ(options.calibration().accelerometer.random_walk, 1e-4);
  EXPECT_EQ(config::print(options_of(config::print(options))), config::print(options));
  EXPECT_THAT(error_of([] { return options_of("gyro_noise_density: -1"); }),
              HasSubstr("gyro_noise_density"));
}

TEST(Imu, ExtrinsicsMustBeRigid) {
  const auto error = error_of([] {
    return options_of("T_camera_imu: [[2, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]");
  });
  EXPECT_THAT(error, AllOf(HasSubstr("a.yaml:1"), HasSubstr("T_camera_imu"), HasSubstr("rigid")));
}

}  // namespace
}  // namespace saccade
