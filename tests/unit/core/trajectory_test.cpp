#include "core/trajectory.h"

#include <type_traits>
#include <vector>

#include <gtest/gtest.h>

namespace saccade {
namespace {

Trajectory zigzag() {
  return Trajectory({{1, Rigid3(Eigen::Quaterniond::Identity(), {0, 0, 0})},
                     {2, Rigid3(so3_exp({0, 0, 1}), {1, 0, 0})},
                     {4, Rigid3(so3_exp({0, 0, 1}), {1, 2, 0})}});
}

TEST(Trajectory, InterpolatesBetweenNeighbours) {
  const Rigid3 pose = *zigzag().at(1.25);
  EXPECT_LT((pose.translation() - Eigen::Vector3d(0.25, 0, 0)).norm(), 1e-15);
  EXPECT_LT((so3_log(pose.rotation()) - Eigen::Vector3d(0, 0, 0.25)).norm(), 1e-14);
}

TEST(Trajectory, PassesThroughItsPoses) {
  const Trajectory trajectory = zigzag();
  for (const StampedPose& p : trajectory.poses())
    EXPECT_EQ(trajectory.at(p.t_s)->translation(), p.world_from_camera.translation());
}

TEST(Trajectory, EndsAreHeldOrRefused) {
  EXPECT_FALSE(zigzag().at(0.999));
  EXPECT_FALSE(zigzag().at(4.001));
  EXPECT_EQ(zigzag().at_clamped(0).translation(), Eigen::Vector3d(0, 0, 0));
  EXPECT_EQ(zigzag().at_clamped(9).translation(), Eigen::Vector3d(1, 2, 0));
  EXPECT_FALSE(Trajectory().at(0));
}

TEST(Trajectory, LastBefore) {
  EXPECT_EQ(zigzag().last_before(0.5), std::nullopt);
  EXPECT_EQ(zigzag().last_before(1), 0U);
  EXPECT_EQ(zigzag().last_before(3.9), 1U);
  EXPECT_EQ(zigzag().last_before(9), 2U);
}

TEST(Trajectory, PosesOfATemporaryOutliveIt) {
  static_assert(std::is_same_v<decltype(zigzag().poses()), std::vector<StampedPose>>);
  double sum_s = 0;
  for (const StampedPose& p : zigzag().poses()) sum_s += p.t_s;
  EXPECT_EQ(sum_s, 7);
}

TEST(Trajectory, PathLengthSumsTheSteps) {
  EXPECT_DOUBLE_EQ(zigzag().path_length(), 3);
  EXPECT_EQ(Trajectory().path_length(), 0);
}

}  // namespace
}  // namespace saccade
