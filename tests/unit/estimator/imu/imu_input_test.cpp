#include "estimator/imu/imu_input.h"

#include <gtest/gtest.h>

namespace saccade {
namespace {

ImuInput at_rest(const Eigen::Vector3d& specific_force) {
  ImuInput input;
  for (int i = 0; i < 3; ++i) {
    ImuSample sample;
    sample.t_ns = 1'000'000LL * i;
    sample.specific_force = specific_force;
    input.samples.push_back(sample);
  }
  return input;
}

TEST(Levelled, PutsTheMeanForceUpright) {
  const Rigid3 tilted(so3_exp({0.2, 0, 0.5}), Eigen::Vector3d::Zero());
  const Trajectory level =
      gravity_aligned(Trajectory({{0, tilted}, {0.002, tilted}}), at_rest({0, 0, 9.81}));
  const Eigen::Vector3d up =
      level.poses()[1].world_from_camera.rotation() * Eigen::Vector3d::UnitZ();
  EXPECT_NEAR(up.z(), 1, 1e-12);
}

TEST(Levelled, KeepsOrientationsWhereNoForceSaysWhatIsLevel) {
  const Rigid3 tilted(so3_exp({0.2, 0, 0.5}), Eigen::Vector3d::Zero());
  const Trajectory kept =
      gravity_aligned(Trajectory({{0, tilted}, {0.002, tilted}}), at_rest({0, 0, 0}));
  EXPECT_LT(angle_between(kept.poses()[0].world_from_camera.rotation(), tilted.rotation()), 1e-12);
}

}  // namespace
}  // namespace saccade
