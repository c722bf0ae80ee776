#include "estimator/odometry/start/extrapolated_path.h"

#include <gtest/gtest.h>

#include <vector>

#include "core/imu_sample.h"
#include "core/random.h"

namespace saccade {
namespace {

const Twist kVelocity = (Twist() << 0.5, -0.1, 0.2, 0.1, -0.3, 0.2).finished();

/// Steady from the identity on, a pose every 5 ms.
Trajectory steady(double end_s) {
  std::vector<StampedPose> poses;
  for (int i = 0; i * 5e-3 <= end_s + 1e-9; ++i)
    poses.push_back({i * 5e-3, Rigid3::exp(i * 5e-3 * kVelocity)});
  return Trajectory(std::move(poses));
}

TEST(CarriedPath, ASteadyMotionGoesOnAsItIs) {
  const Trajectory path = extrapolated(steady(0.05), 0.12, {});
  EXPECT_GE(path.end_s(), 0.12);
  EXPECT_LE(path.end_s(), 0.12 + kPoseSpacing_s);
  for (const StampedPose& pose : path.poses())
    EXPECT_LT((Rigid3::exp(pose.t_s * kVelocity).inverse() * pose.world_from_camera).log().norm(),
              1e-9);
}

TEST(CarriedPath, ThePosesBeforeAreKept) {
  const Trajectory before = steady(0.05);
  const Trajectory path = extrapolated(before, 0.06, {});
  ASSERT_GT(path.size(), before.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_EQ(path.poses()[i].t_s, before.poses()[i].t_s);
    EXPECT_EQ(path.poses()[i].world_from_camera.translation(),
              before.poses()[i].world_from_camera.translation());
  }
}

TEST(CarriedPath, APathShorterThanTheLookBackTellsItsVelocity) {
  const Trajectory path = extrapolated(steady(0.005), 0.02, {});
  const StampedPose last = path.poses().back();
  EXPECT_LT((Rigid3::exp(last.t_s * kVelocity).inverse() * last.world_from_camera).log().norm(),
            1e-9);
}

/// From rest on, at a constant acceleration of the twist.
Trajectory accelerated(double end_s, double every_s = 5e-3) {
  std::vector<StampedPose> poses;
  for (int i = 0; i * every_s <= end_s + 1e-9; ++i) {
    const double t_s = i * every_s;
    poses.push_back({t_s, Rigid3::exp(5 * t_s * t_s * kVelocity)});
  }
  return Trajectory(std::move(poses));
}

TEST(CarriedPath, AnAccelerationLastsAsLongAgainAsItWasSeen) {
  const Trajectory before = accelerated(0.05);
  const PathAcceleration acceleration = last_acceleration(before);
  EXPECT_LT((acceleration.rate - 10 * kVelocity).norm(), 0.01 * kVelocity.norm());
  EXPECT_NEAR(acceleration.until_s, 0.1, 1e-12);
  const Trajectory path = extrapolated(before, 0.2, {}, acceleration);
  for (const StampedPose& pose : path.poses()) {
    const double t_s = pose.t_s;
    const double way_s = t_s <= 0.1 ? 5 * t_s * t_s : 0.05 + (t_s - 0.1);  // then at 10 * 0.1 s
    ASSERT_LT((Rigid3::exp(way_s * kVelocity).inverse() * pose.world_from_camera).log().norm(),
              0.003 * kVelocity.norm())
        << t_s;
  }
  // The same in steps, also where it ends within the last 20 ms.
  Trajectory steps = before;
  for (const double until_s : {0.07, 0.095, 0.107, 0.115, 0.2})
    steps = extrapolated(steps, until_s, {}, acceleration);
  EXPECT_LT((steps.at_clamped(0.2).inverse() * path.at_clamped(0.2)).log().norm(),
            0.003 * kVelocity.norm());
  const Trajectory steady_on = extrapolated(before, 0.2, {});
  EXPECT_LT(steady_on.poses().back().world_from_camera.translation().norm(),
            0.7 * path.poses().back().world_from_camera.translation().norm());
}

/// From rest on, the acceleration growing.
Trajectory hastening(double end_s) {
  std::vector<StampedPose> poses;
  for (int i = 0; i * 1e-3 <= end_s + 1e-9; ++i) {
    const double t_s = i * 1e-3;
    poses.push_back({t_s, Rigid3::exp(40 * t_s * t_s * t_s * kVelocity)});
  }
  return Trajectory(std::move(poses));
}

TEST(CarriedPath, AnAccelerationThatChangesGoesOnToChange) {
  const Trajectory before = hastening(0.05);
  const PathAcceleration acceleration = last_acceleration(before);
  EXPECT_LT((acceleration.rate - 12 * kVelocity).norm(), 0.02 * 12 * kVelocity.norm());
  EXPECT_LT((acceleration.jerk - 240 * kVelocity).norm(), 0.02 * 240 * kVelocity.norm());
  const auto error = [&](const Trajectory& path, double t_s) {
    const Twist way = 40 * t_s * t_s * t_s * kVelocity;
    return (Rigid3::exp(way).inverse() * path.at_clamped(t_s)).log().norm() / way.norm();
  };
  EXPECT_LT(error(extrapolated(before, 0.1, {}, acceleration), 0.1), 0.01);
  // The same in steps, of which the last ends within 20 ms after the change ends.
  Trajectory steps = before;
  for (const double until_s : {0.07, 0.095, 0.107, 0.15})
    steps = extrapolated(steps, until_s, {}, acceleration);
  EXPECT_LT(error(steps, 0.1), 0.01);
  EXPECT_LT((steps.at_clamped(0.15).inverse() *
             extrapolated(before, 0.15, {}, acceleration).at_clamped(0.15))
                .log()
                .norm(),
            0.01 * 40 * 0.15 * 0.15 * 0.15 * kVelocity.norm());
  PathAcceleration alone = acceleration;
  alone.jerk.setZero();
  EXPECT_GT(error(extrapolated(before, 0.1, {}, alone), 0.1), 0.1) << "it matters";
}

TEST(CarriedPath, AChangeWithinTheNoiseDoesNotCount) {
  int changing = 0;
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    const Random random(seed);
    std::vector<StampedPose> poses;
    for (std::uint64_t i = 0; i <= 100; ++i) {
      Twist way = 1e-3 * static_cast<double>(i) * kVelocity;
      for (Eigen::Index k = 0; k < 6; ++k)
        way[k] += 2e-3 * (random.uniform(i, static_cast<std::uint64_t>(k)) - 0.5);
      poses.push_back({1e-3 * static_cast<double>(i), Rigid3::exp(way)});
    }
    const Twist jerk = last_acceleration(Trajectory(std::move(poses))).jerk;
    for (const double each : jerk) changing += each != 0 ? 1 : 0;
  }
  EXPECT_LE(changing, 1) << "of 180: four sigmas";
}

TEST(CarriedPath, OfALongPathTheLastTenthOfASecondCounts) {
  EXPECT_NEAR(last_acceleration(accelerated(0.3)).until_s, 0.4, 1e-12);
  EXPECT_LT(last_acceleration(steady(0.3)).rate.norm(), 1e-6);
}

TEST(CarriedPath, TwoPosesTellNoAcceleration) {
  const PathAcceleration acceleration = last_acceleration(steady(0.005));
  EXPECT_EQ(acceleration.rate.norm(), 0);
}

TEST(CarriedPath, AGyroscopeTellsTheTurnBeyond) {
  std::vector<ImuSample> readings(2);
  readings[1].t_ns = ns_from_seconds(1.0);
  const Eigen::Vector3d rate(0, 0, 2);
  for (ImuSample& reading : readings) reading.angular_velocity = rate;
  const Gyroscope gyroscope(readings, Eigen::Matrix3d::Identity(), Eigen::Vector3d::Zero());
  const Trajectory before = steady(0.05);
  const Trajectory path = extrapolated(before, 0.1, gyroscope);
  const StampedPose last = path.poses().back();
  const Eigen::Quaterniond expected =
      before.poses().back().world_from_camera.rotation() * so3_exp((last.t_s - 0.05) * rate);
  EXPECT_LT(angle_between(last.world_from_camera.rotation(), expected), 1e-6);
}

}  // namespace
}  // namespace saccade
