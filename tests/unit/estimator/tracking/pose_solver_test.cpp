#include "estimator/tracking/pose_solver.h"

#include <gtest/gtest.h>

namespace saccade {
namespace {

Twist some_twist() {
  Twist twist;
  twist << 0.02, -0.01, 0.03, 0.01, 0.02, -0.015;
  return twist;
}

/// Equations of residuals that say the pose is exp(`twist`): J = 1 for every unknown.
PoseEquations towards(const Twist& twist, const Rigid3& at, double weight) {
  PoseEquations equations;
  equations.normal.diagonal().setConstant(weight);
  equations.rhs = weight * (at.inverse() * Rigid3::exp(twist)).log();
  return equations;
}

TEST(PoseSolver, WithoutAPriorItGoesWhereTheResidualsSay) {
  PoseSolver pose({}, 1);
  for (int i = 0; i < 3; ++i)
    ASSERT_TRUE(pose.step(towards(some_twist(), pose.map_from_camera(), 2)));
  EXPECT_LT((pose.map_from_camera().log() - some_twist()).norm(), 1e-12);
}

TEST(PoseSolver, PredictionAndResidualsShareByTheirInformation) {
  // Residuals of information 5 * 2 against a prior of 30: a quarter of the way.
  PosePrediction predicted;
  predicted.precision.diagonal().setConstant(30);
  PoseSolver pose(predicted, 5);
  PoseEquations equations;
  for (int i = 0; i < 10; ++i) {
    equations = towards(some_twist(), pose.map_from_camera(), 2);
    ASSERT_TRUE(pose.step(equations));
  }
  EXPECT_LT((pose.map_from_camera().log() - some_twist() / 4).norm(), 1e-4);
  EXPECT_EQ(pose.information(equations), Matrix6(10 * Matrix6::Identity()));
}

TEST(PoseSolver, SingularEquationsTakeNoStep) {
  PoseSolver pose({}, 1);
  PoseEquations nothing;
  nothing.rhs = some_twist();
  EXPECT_FALSE(pose.step(nothing));
  EXPECT_EQ(pose.map_from_camera().translation(), Eigen::Vector3d(0, 0, 0));
}

}  // namespace
}  // namespace saccade
