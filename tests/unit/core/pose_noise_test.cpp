#include "core/pose_noise.h"

#include <gtest/gtest.h>

#include <vector>

#include "core/random.h"
#include "tests/support/handheld_motion.h"

namespace saccade {
namespace {

constexpr double kDuration_s = 2;
constexpr double kRate_hz = 200;
constexpr double kRotationNoise_rad = 4e-3;
constexpr double kPositionNoise_m = 1e-3;

/// A hand's motion as motion capture records it, with noise of `share` of the constants above.
Trajectory recorded(const Spline& motion, double share) {
  const Random random(7);
  std::vector<StampedPose> poses;
  std::uint64_t draw = 0;
  const auto noise = [&](double sigma) {
    Eigen::Vector3d vector;
    for (double& value : vector) value = share * sigma * random.normal(0, draw++);
    return vector;
  };
  for (int i = 0; i <= static_cast<int>(kDuration_s * kRate_hz); ++i) {
    const double t_s = i / kRate_hz;
    const Rigid3 pose = motion.pose(t_s);
    poses.push_back({t_s, Rigid3(pose.rotation() * so3_exp(noise(kRotationNoise_rad)),
                                 pose.translation() + noise(kPositionNoise_m))});
  }
  return Trajectory(std::move(poses));
}

double rms_rotation_error_rad(const Trajectory& found, const Spline& truth) {
  double squares = 0;
  for (const StampedPose& pose : found.poses())
    squares +=
        so3_log(truth.pose(pose.t_s).rotation().conjugate() * pose.world_from_camera.rotation())
            .squaredNorm();
  return std::sqrt(squares / static_cast<double>(found.size()));
}

TEST(PoseNoise, IsThatOfTheRecording) {
  const PoseNoise noise = pose_noise_of(recorded(testing::handheld_motion(kDuration_s), 1));
  EXPECT_NEAR(noise.rotation_rad, kRotationNoise_rad, 0.1 * kRotationNoise_rad);
  EXPECT_NEAR(noise.position_m, kPositionNoise_m, 0.1 * kPositionNoise_m);
  EXPECT_NEAR(noise.spacing_s, 1 / kRate_hz, 1e-9);
  EXPECT_NEAR(noise.poses_within(0.1), 20, 1e-6);
}

TEST(PoseNoise, IsNoneOfSmoothMotionHoweverFast) {
  const PoseNoise noise = pose_noise_of(recorded(testing::handheld_motion(kDuration_s), 0));
  EXPECT_LT(noise.rotation_rad, 0.01 * kRotationNoise_rad);
  EXPECT_LT(noise.position_m, 0.01 * kPositionNoise_m);
}

TEST(PoseNoise, OfAFewPosesIsNotKnown) {
  const PoseNoise none = pose_noise_of(Trajectory({{0, {}}, {1, {}}}));
  EXPECT_EQ(none.rotation_rad, 0);
  EXPECT_EQ(none.poses_within(1), 1);
}

TEST(SmoothedPoses, HoldLessNoiseThanTheRecording) {
  const Spline motion = testing::handheld_motion(kDuration_s);
  const Trajectory noisy = recorded(motion, 1);
  const Trajectory smooth = smoothed(noisy, 0.04);
  EXPECT_DOUBLE_EQ(smooth.start_s(), noisy.start_s());
  EXPECT_DOUBLE_EQ(smooth.end_s(), noisy.end_s());
  // A knot holds eight poses.
  EXPECT_LT(rms_rotation_error_rad(smooth, motion), 0.5 * rms_rotation_error_rad(noisy, motion));
}

}  // namespace
}  // namespace saccade
