#include "estimator/mosaic/rate_offset.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/rigid3.h"
#include "tests/support/direction_world.h"

namespace saccade {
namespace {

constexpr double kEnd_s = 1.2;

PinholeCamera camera() { return {120, 90, 150, 150, 59.5, 44.5, {}}; }

/// To and fro, so that directions are observed again.
Eigen::Quaterniond swing(double t_s) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(0.7 * std::sin(6 * t_s), Eigen::Vector3d::UnitZ()) *
                            Eigen::AngleAxisd(0.3 * std::sin(9 * t_s), Eigen::Vector3d::UnitY())) *
         testing::sweep(0, 0)(0);
}

Trajectory true_poses() {
  std::vector<StampedPose> poses;
  for (int i = 0; i <= static_cast<int>(1000 * kEnd_s); ++i)
    poses.push_back({1e-3 * i, {swing(1e-3 * i), Eigen::Vector3d::Zero()}});
  return Trajectory(std::move(poses));
}

TEST(RateOffset, IsTakenOutOfEveryTurnAndNotOfTheStart) {
  const Eigen::Vector3d rate(0.1, -0.2, 0.05);
  const Trajectory corrected = without_rate(true_poses(), rate, 0.5);
  const auto rotation = [](const Trajectory& poses, double from_s, double to_s) {
    return poses.at_clamped(from_s).rotation().conjugate() * poses.at_clamped(to_s).rotation();
  };
  EXPECT_LT(
      angle_between(corrected.at_clamped(0.5).rotation(), true_poses().at_clamped(0.5).rotation()),
      1e-9);
  for (const double t_s : {0.1, 0.9})
    EXPECT_LT((so3_log(rotation(true_poses(), t_s, t_s + 1e-3)) -
               so3_log(rotation(corrected, t_s, t_s + 1e-3)) - 1e-3 * rate)
                  .norm(),
              1e-6);
  // There and back again.
  const Trajectory same = without_rate(corrected, -rate, 0.5);
  EXPECT_LT(
      angle_between(same.at_clamped(kEnd_s).rotation(), true_poses().at_clamped(kEnd_s).rotation()),
      1e-4);
}

TEST(RateOffset, FindsTheBiasOfAGyroscope) {
  const testing::DirectionWorld world(camera());
  const Events events = world.simulate(swing, kEnd_s, 0.1);
  const Eigen::Vector3d bias(0.04, -0.03, 0.05);
  const Trajectory biased = without_rate(true_poses(), -bias, 0);
  const Eigen::Vector3d found = sharpest_rate_offset(events, camera(), biased, camera().fx, 30000);
  EXPECT_LT((found - bias).norm(), 0.2 * bias.norm()) << found.transpose();
}

}  // namespace
}  // namespace saccade
