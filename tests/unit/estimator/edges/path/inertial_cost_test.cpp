#include "estimator/edges/path/inertial_cost.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/handheld_motion.h"
#include "tests/support/jacobian_check.h"

namespace saccade {
namespace {

constexpr double kFrom_s = 0.53, kTo_s = 0.63;
constexpr int kControls = 6;
constexpr int kSize = 6 * kControls + 3 + 3 + 6 + InertialFrame::kSize;
using Unknowns = Eigen::Matrix<double, kSize, 1>;
using InertialResidual = Eigen::Matrix<double, 9, 1>;

const Eigen::Vector3d kPlace(0.05, -0.1, 0.02);

struct World {
  Spline motion = testing::handheld_motion(1);
  SplineKnots knots = SplineKnots::over(0, 1, 0.05);
  InertialFrame frame = InertialFrame::about(testing::kGravity);

  [[nodiscard]] InertialNode node(double t_s) const {
    const SplineState state = motion.state(t_s);
    Twist twist;
    twist.head<3>() = state.world_from_body.rotation().conjugate() * state.velocity_in_world;
    twist.tail<3>() = state.angular_velocity_in_body;
    return {state.world_from_body, twist, knots.at(t_s)};
  }

  [[nodiscard]] InertialCost cost() const {
    const Rigid3 camera_from_imu(Eigen::Quaterniond::Identity(), kPlace);
    const auto readings =
        testing::imu_readings(motion, camera_from_imu, {0.01, 0.02, -0.01}, {0.1, -0.1, 0.05});
    const auto sum =
        preintegrate(readings, kFrom_s, kTo_s, {{0.01, 0.02, -0.01}, {0.1, -0.1, 0.05}},
                     {1000, {1e-2, 0}, {1e-3, 0}});
    return {{node(kFrom_s), node(kTo_s)}, *sum, kPlace, frame, InertialCost::Matrix9::Identity()};
  }

  /// The truth: no correction, the motion's velocities and the biases, a scale of 1.
  [[nodiscard]] Unknowns truth() const {
    const Rigid3 camera_from_imu(Eigen::Quaterniond::Identity(), kPlace);
    Unknowns x = Unknowns::Zero();
    x.segment<3>(36) = motion.state(kFrom_s).attached(camera_from_imu).velocity_in_world;
    x.segment<3>(39) = motion.state(kTo_s).attached(camera_from_imu).velocity_in_world;
    x.segment<6>(42) << 0.01, 0.02, -0.01, 0.1, -0.1, 0.05;
    x[48 + InertialFrame::kScale] = 1;
    return x;
  }
};

InertialResidual evaluate(const InertialCost& cost, const Unknowns& x, double** jacobians) {
  std::vector<const double*> blocks;
  for (int k = 0; k < kControls; ++k) blocks.push_back(x.data() + 6 * k);
  for (const int at : {36, 39, 42, 48}) blocks.push_back(x.data() + at);
  InertialResidual residual;
  EXPECT_TRUE(cost.Evaluate(blocks.data(), residual.data(), jacobians));
  return residual;
}

TEST(InertialCost, IsNothingForTheTruth) {
  const World world;
  const InertialCost cost = world.cost();
  EXPECT_EQ(cost.controls(), static_cast<std::size_t>(kControls));
  EXPECT_LT(evaluate(cost, world.truth(), nullptr).norm(), 1e-4);
}

TEST(InertialCost, HasItsDerivatives) {
  const World world;
  const InertialCost cost = world.cost();
  Unknowns at = world.truth();
  for (Eigen::Index i = 0; i < kSize; ++i) at[i] += 0.02 * std::sin(1.7 * static_cast<double>(i));
  std::vector<std::vector<double>> blocks;
  std::vector<double*> jacobians;
  for (const int size : cost.parameter_block_sizes())
    blocks.emplace_back(static_cast<std::size_t>(9 * size));
  for (auto& block : blocks) jacobians.push_back(block.data());
  evaluate(cost, at, jacobians.data());
  Eigen::Matrix<double, 9, kSize> all;
  Eigen::Index column = 0;
  for (const auto& block : blocks) {
    const auto size = static_cast<Eigen::Index>(block.size() / 9);
    for (Eigen::Index r = 0; r < 9; ++r)
      for (Eigen::Index c = 0; c < size; ++c)
        all(r, column + c) = block[static_cast<std::size_t>(r * size + c)];
    column += size;
  }
  testing::expect_jacobian<9, kSize>(
      all, [&](const Unknowns& x) { return evaluate(cost, x, nullptr); }, at);
}

}  // namespace
}  // namespace saccade
