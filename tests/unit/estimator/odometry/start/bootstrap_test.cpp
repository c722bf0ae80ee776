#include "estimator/odometry/start/bootstrap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/imu_sample.h"
#include "core/random.h"
#include "estimator/odometry/start/start_trial.h"
#include "tests/support/planar_world.h"

namespace saccade {
namespace {

constexpr double kEnd_s = 0.2;

const Eigen::Vector3d kRate(0.1, -0.25, 0.3);

/// Sideways with a turn, in front of a corner.
Rigid3 glide(double t_s) { return {so3_exp(t_s * kRate), {1.2 * t_s, 0.3 * t_s, 0.1 * t_s}}; }

const testing::PlanarWorld& world() {
  static const testing::PlanarWorld world = testing::corner_world(160, 120);
  return world;
}

Events recorded(const testing::Motion& motion, double end_s) {
  return world().simulate(motion, 0, end_s, 1e-3, 0.15);
}

BootstrapOptions quick() {
  BootstrapOptions options;
  options.window_s = kEnd_s;
  options.growth = 1.4;
  options.refinement.adjustment.edges = 500;
  return options;
}

/// Of the found path, scaled to fit, from the true one's part: at the most, relative to the depth.
struct Errors {
  double position = 0, turn_rad = 0;
};

Errors errors_of(const Trajectory& path, const testing::Motion& truth) {
  const Rigid3 start_from_world = truth(path.start_s()).inverse();
  double product = 0, squares = 0;
  for (const StampedPose& pose : path.poses()) {
    const Rigid3 at = start_from_world * truth(pose.t_s);
    product += at.translation().dot(pose.world_from_camera.translation());
    squares += pose.world_from_camera.translation().squaredNorm();
  }
  const double scale = product / squares;
  Errors errors;
  for (const StampedPose& pose : path.poses()) {
    const Rigid3 at = start_from_world * truth(pose.t_s);
    const double off =
        (scale * pose.world_from_camera.translation() - at.translation()).norm() / scale;
    errors.position = std::max(errors.position, off);
    errors.turn_rad =
        std::max(errors.turn_rad, angle_between(pose.world_from_camera.rotation(), at.rotation()));
  }
  return errors;
}

TEST(Bootstrap, FindsThePathUpToScale) {
  BootstrapOptions options = quick();
  options.depth_m = 2;
  const Bootstrap start = find_start(recorded(glide, kEnd_s), world().camera(), options);
  ASSERT_EQ(start.status, Bootstrap::Status::kFound);
  EXPECT_LT(start.path.start_s(), 0.01);
  EXPECT_GT(start.path.end_s(), 0.15);
  EXPECT_GT(start.edges, 200U);
  EXPECT_LT(start.path.poses().front().world_from_camera.log().norm(), 1e-12);
  const Errors errors = errors_of(start.path, glide);
  EXPECT_LT(errors.position, 0.01 * options.depth_m);
  // The camera moved by a tenth of the depth, 15 px of a small picture, and turned by 0.08 rad: a
  // turn and a step are told apart to a few pixels.
  EXPECT_LT(errors.turn_rad, 0.05);
  const double way = start.path.poses().back().world_from_camera.translation().norm();
  EXPECT_NEAR(start.parallax_px, world().camera().fx * way / options.depth_m, 0.2)
      << "the typical depth is the unit";
}

TEST(Bootstrap, AGyroscopeTellsTheTurn) {
  std::vector<ImuSample> readings(2);
  readings[1].t_ns = ns_from_seconds(kEnd_s);
  for (ImuSample& reading : readings) reading.angular_velocity = kRate;
  const Gyroscope gyroscope(readings, Eigen::Matrix3d::Identity(), Eigen::Vector3d::Zero());
  const Events events = recorded(glide, kEnd_s);
  const Bootstrap start = find_start(events, world().camera(), quick(), gyroscope);
  ASSERT_EQ(start.status, Bootstrap::Status::kFound);
  const Errors errors = errors_of(start.path, glide);
  EXPECT_LT(errors.turn_rad, 2e-3) << "a tenth of what events alone are held to, and less";
  EXPECT_LT(errors.position, 5e-3);
}

TEST(Bootstrap, WaitsUntilTheCameraMoves) {
  constexpr double kRest_s = 0.15;
  const auto motion = [](double t_s) { return glide(std::max(0.0, t_s - kRest_s)); };
  const Bootstrap start = find_start(recorded(motion, kRest_s + kEnd_s), world().camera(), quick());
  ASSERT_EQ(start.status, Bootstrap::Status::kFound);
  EXPECT_LT(start.path.start_s(), kRest_s + 0.05);
  EXPECT_LT(errors_of(start.path, motion).position, 0.02);
}

TEST(Bootstrap, AMotionOfAFewPixelsEnds) {
  const auto slow = [](double t_s) { return glide(0.1 * t_s); };
  BootstrapOptions options = quick();
  options.max_search_s = 0.15;
  EXPECT_NE(find_start(recorded(slow, kEnd_s), world().camera(), options).status,
            Bootstrap::Status::kFound);
}

TEST(Bootstrap, ARotationIsAStartWithoutParallax) {
  const auto turn = [](double t_s) { return Rigid3(so3_exp(4 * t_s * kRate), {0, 0, 0}); };
  const Bootstrap start =
      find_start(recorded(turn, kEnd_s + kStartTrial_s), world().camera(), quick());
  ASSERT_EQ(start.status, Bootstrap::Status::kFound);
  EXPECT_LT(start.parallax_px, 2) << "its turn moves the picture by 40 px";
  for (const StampedPose& pose : start.path.poses()) {
    const Rigid3 at = turn(start.path.start_s()).inverse() * turn(pose.t_s);
    EXPECT_LT(angle_between(pose.world_from_camera.rotation(), at.rotation()), 0.01);
    EXPECT_LT(pose.world_from_camera.translation().norm(), 0.02) << "of a typical depth of 1";
  }
}

TEST(Bootstrap, WithoutATrialARotationIsNoStart) {
  const auto turn = [](double t_s) { return Rigid3(so3_exp(4 * t_s * kRate), {0, 0, 0}); };
  EXPECT_EQ(find_start(recorded(turn, kEnd_s), world().camera(), quick()).status,
            Bootstrap::Status::kUnexplained);
}

TEST(Bootstrap, FindsThePathOfAShakenCamera) {
  // To and fro at 3 Hz by 0.04 rad and a pixel of parallax: no direction of motion can be told.
  const auto shaken = [](double t_s) {
    const double angle = 0.04 * std::sin(6 * M_PI * t_s);
    return Rigid3(so3_exp(angle * Eigen::Vector3d(0.4, 1, -0.5)),
                  {0.01 * std::sin(25 * t_s), 0, 0});
  };
  const Bootstrap start =
      find_start(recorded(shaken, kEnd_s + kStartTrial_s), world().camera(), quick());
  ASSERT_EQ(start.status, Bootstrap::Status::kFound);
  EXPECT_GT(start.path.end_s() - start.path.start_s(), 0.15);
  double turn_rad = 0, error_rad = 0, way = 0;
  for (const StampedPose& pose : start.path.poses()) {
    const Rigid3 at = shaken(start.path.start_s()).inverse() * shaken(pose.t_s);
    turn_rad = std::max(turn_rad, 2 * at.rotation().vec().norm());
    error_rad =
        std::max(error_rad, angle_between(pose.world_from_camera.rotation(), at.rotation()));
    way = std::max(way, pose.world_from_camera.translation().norm());
  }
  EXPECT_GT(turn_rad, 0.04);
  EXPECT_LT(error_rad, turn_rad / 3) << "one that stays where it is would be off by all of it";
  EXPECT_LT(way, 0.05) << "what it moves less than would make it lost";
}

TEST(Bootstrap, NoiseIsNoMotion) {
  const Random random(3);
  Events events;
  for (std::uint64_t i = 0; i < 4000; ++i)
    events.push_back({static_cast<TimeNs>(i) * 50000,
                      static_cast<std::uint16_t>(160 * random.uniform(i, 0)),
                      static_cast<std::uint16_t>(120 * random.uniform(i, 1)),
                      random.uniform(i, 2) < 0.5 ? std::int8_t{-1} : std::int8_t{1}});
  EXPECT_EQ(find_start(events, world().camera(), quick()).status, Bootstrap::Status::kNoMotion);
  EXPECT_EQ(find_start({}, world().camera(), quick()).status, Bootstrap::Status::kNoMotion);
}

}  // namespace
}  // namespace saccade
