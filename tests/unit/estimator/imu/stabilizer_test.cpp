#include "estimator/imu/stabilizer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/rigid3.h"
#include "estimator/imu/orientation_smoothing.h"

namespace saccade {
namespace {

const PinholeCamera kCamera{240, 180, 200, 210, 118, 91, {-0.2, 0.05, 1e-3, -5e-4, 0}};

Eigen::Quaterniond trembling(double t_s) {
  return so3_exp(
      {0.1 * std::sin(60 * t_s), 0.12 * std::sin(45 * t_s + 1), 0.2 * std::sin(30 * t_s)});
}

Trajectory shaking(double duration_s) {
  std::vector<StampedPose> poses;
  for (int i = 0; i <= static_cast<int>(1000 * duration_s); ++i)
    poses.push_back({1e-3 * i, {trembling(1e-3 * i), {1, 2, 3}}});
  return Trajectory(std::move(poses));
}

TEST(Stabilizer, PutsAllEventsOfADirectionOnOnePoint) {
  const Trajectory trajectory = shaking(0.2);
  const Stabilizer stabilizer(kCamera, trajectory);
  const Eigen::Quaterniond steady = so3_exp({0.02, -0.01, 0.1});
  const Eigen::Vector3d direction = Eigen::Vector3d(0.1, -0.05, 1);
  const Eigen::Vector2d expected = kCamera.project(steady.conjugate() * direction);
  int seen = 0;
  for (int i = 0; i < 2000; ++i) {
    const TimeNs t_ns = i * 100'000;
    const Eigen::Quaterniond camera = trajectory.at(seconds_from_ns(t_ns))->rotation();
    const Eigen::Vector2d pixel = kCamera.distort(kCamera.project(camera.conjugate() * direction));
    const Event event{t_ns, static_cast<std::uint16_t>(std::lround(pixel.x())),
                      static_cast<std::uint16_t>(std::lround(pixel.y())), 1};
    if (!kCamera.contains(pixel)) continue;
    ++seen;
    const auto stabilized = stabilizer.stabilize({&event, 1}, steady);
    ASSERT_EQ(stabilized.size(), 1U);
    // A pixel is half a pixel off in each direction, and the lens stretches it.
    EXPECT_NEAR(stabilized[0].x, expected.x(), 0.75);
    EXPECT_NEAR(stabilized[0].y, expected.y(), 0.75);
    EXPECT_EQ(stabilized[0].source.t_ns, t_ns);
  }
  EXPECT_GT(seen, 1500);
}

TEST(Stabilizer, EventsKeepTheirSubPixelPlaceInAStillCamera) {
  const Trajectory still({{0, {}}, {1, {}}});
  const Stabilizer stabilizer(kCamera, still);
  const UndistortionTable table(kCamera);
  const Events events{{0, 3, 5, 1}, {1000, 200, 170, -1}};
  const auto stabilized = stabilizer.stabilize(events, Eigen::Quaterniond::Identity());
  for (std::size_t i = 0; i < events.size(); ++i) {
    EXPECT_NEAR(stabilized[i].x, table(events[i].x, events[i].y).x(), 1e-4);
    EXPECT_NEAR(stabilized[i].y, table(events[i].x, events[i].y).y(), 1e-4);
  }
}

TEST(Stabilizer, WhatIsBehindTheSteadyViewIsNowhere) {
  const Trajectory still({{0, {}}, {1, {}}});
  const Stabilizer stabilizer(kCamera, still);
  const Event event{0, 120, 90, 1};
  const auto stabilized = stabilizer.stabilize({&event, 1}, so3_exp({0, std::numbers::pi, 0}));
  EXPECT_FALSE(std::isfinite(stabilized[0].x) &&
               kCamera.contains({stabilized[0].x, stabilized[0].y}));
  EXPECT_TRUE(stabilizer.stabilize({}, Eigen::Quaterniond::Identity()).empty());
}

TEST(Stabilizer, TurnsAPictureToTheSteadyView) {
  // Brightness is a function of the direction in the world.
  const auto brightness = [](const Eigen::Vector3d& ray) {
    const Eigen::Vector3d d = ray.normalized();
    return static_cast<float>(0.5 + 0.2 * std::sin(12 * d.x()) + 0.2 * std::cos(9 * d.y()));
  };
  const Trajectory trajectory = shaking(0.1);
  const double t_s = 0.037;
  const Eigen::Quaterniond camera = trajectory.at(t_s)->rotation();
  ImageF picture(kCamera.width, kCamera.height);
  for (int y = 0; y < picture.height(); ++y)
    for (int x = 0; x < picture.width(); ++x)
      picture(x, y) = brightness(camera * kCamera.ray(kCamera.undistort({x, y})));
  const Eigen::Quaterniond steady = so3_exp({0.05, 0.02, -0.1});
  const ImageF stabilized = Stabilizer(kCamera, trajectory).stabilize(picture, t_s, steady);
  int seen = 0;
  for (int y = 0; y < picture.height(); ++y)
    for (int x = 0; x < picture.width(); ++x) {
      if (!(stabilized(x, y) > 0)) continue;
      ++seen;
      EXPECT_NEAR(stabilized(x, y), brightness(steady * kCamera.ray({x, y})), 1e-3);
    }
  EXPECT_GT(seen, 20000);
  EXPECT_LT(seen, 240 * 180) << "part of the view lies outside the picture";
}

TEST(OrientationSmoothing, FollowsAStepWithItsTimeConstant) {
  std::vector<StampedPose> poses;
  const Eigen::Quaterniond turned = so3_exp({0.1, 0.2, 0});
  for (int i = 0; i <= 1000; ++i)
    poses.push_back({1e-3 * i, {i == 0 ? Eigen::Quaterniond::Identity() : turned, {0, 0, 0}}});
  SmoothingOptions options;
  options.low_pass = SmoothingOptions::LowPass::kCausal;
  options.time_constant_s = 0.25;
  const Trajectory smoothed = smoothed_orientations(Trajectory(poses), options);
  const double left = angle_between(smoothed.at(0.5)->rotation(), turned);
  EXPECT_NEAR(left / std::hypot(0.1, 0.2), std::exp(-2), 1e-3);
}

/// A camera that pans at 1 rad/s, or stands still but for a tremor of `tremor_rad` at 10 Hz.
Trajectory panned(double rate_rad_s, double tremor_rad) {
  std::vector<StampedPose> poses;
  for (int i = 0; i <= 4000; ++i) {
    const double t_s = 1e-3 * i;
    const double angle = rate_rad_s * t_s + tremor_rad * std::sin(20 * std::numbers::pi * t_s);
    poses.push_back({t_s, {so3_exp({0, angle, 0}), {0, 0, 0}}});
  }
  return Trajectory(std::move(poses));
}

TEST(OrientationSmoothing, ACentredOneDoesNotLagBehindAPan) {
  const Trajectory pan = panned(0.5, 0);
  SmoothingOptions options;
  options.time_constant_s = 0.25;
  const auto lag = [&](double t_s) {
    return angle_between(smoothed_orientations(pan, options).at(t_s)->rotation(),
                         pan.at(t_s)->rotation());
  };
  EXPECT_LT(lag(2), 1e-3);
  // At the ends what is assumed beyond them reaches in.
  EXPECT_LT(lag(0), 0.03 * 0.25);
  EXPECT_LT(lag(4), 0.03 * 0.25);
  options.low_pass = SmoothingOptions::LowPass::kCausal;
  EXPECT_NEAR(lag(2), 0.5 * 0.25, 1e-3);
}

TEST(OrientationSmoothing, ACentredOneRemovesATremorTwice) {
  const Trajectory tremor = panned(0, 0.1);
  SmoothingOptions options;
  options.time_constant_s = 0.1;
  const Trajectory smoothed = smoothed_orientations(tremor, options);
  double most = 0;
  for (double t_s = 1; t_s < 3; t_s += 1e-3)
    most = std::max(most, angle_between(smoothed.at(t_s)->rotation(), {1, 0, 0, 0}));
  const double phase = 20 * std::numbers::pi * 0.1;
  EXPECT_NEAR(most, 0.1 / (1 + phase * phase), 1e-4);
}

TEST(OrientationSmoothing, StaysWithinTheLargestAngle) {
  const Trajectory trajectory = panned(3, 0);
  SmoothingOptions options;
  options.time_constant_s = 10;
  options.max_angle_deg = 15;
  for (const auto low_pass :
       {SmoothingOptions::LowPass::kCentred, SmoothingOptions::LowPass::kCausal}) {
    options.low_pass = low_pass;
    const Trajectory smoothed = smoothed_orientations(trajectory, options);
    for (const double t_s : {0.0, 0.2, 0.5, 1.0, 3.9})
      EXPECT_LE(angle_between(smoothed.at(t_s)->rotation(), trajectory.at(t_s)->rotation()),
                15.001 * std::numbers::pi / 180);
  }
}

TEST(OrientationSmoothing, WithoutRollTheRowsAreLevel) {
  for (int i = 0; i < 50; ++i) {
    const Eigen::Quaterniond q =
        so3_exp({-1.4 + 0.01 * i, 0.3 * std::sin(i), 0.2 * std::cos(3 * i)});
    const Eigen::Quaterniond level = without_roll(q);
    const Eigen::Vector3d forward = Eigen::Vector3d::UnitZ();
    EXPECT_LT((q * forward - level * forward).norm(), 1e-12) << "looks elsewhere";
    EXPECT_NEAR((level * Eigen::Vector3d::UnitX()).z(), 0, 1e-12);
    EXPECT_LT((level * Eigen::Vector3d::UnitY()).z(), 0) << "upside down";
  }
  // Straight down there is no roll, and nearby no jump.
  const Eigen::Quaterniond down = so3_exp({std::numbers::pi, 0, 0});
  EXPECT_LT(angle_between(without_roll(down), down), 1e-9);
  const Eigen::Quaterniond nearly = down * so3_exp({1e-3, 0, 0});
  EXPECT_LT(angle_between(without_roll(nearly), nearly), 0.02);
}

}  // namespace
}  // namespace saccade
