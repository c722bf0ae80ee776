#include "estimator/edges/window/window_costs.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "estimator/edges/least_squares/prior_cost.h"
#include "tests/support/jacobian_check.h"
#include "tests/unit/estimator/uneven_camera.h"

namespace saccade {
namespace {

using testing::uneven_camera;
using Vector6 = Eigen::Matrix<double, 6, 1>;

EdgeObservation observation(double x) {
  EdgeObservation o;
  o.view_from_camera = Rigid3::exp((Twist() << x, -0.05, 0.02, 0.03, -0.02, 0.05).finished());
  o.ray = {0.21, -0.13, 1};
  o.lag = -1;
  o.pixel = {165, 62};
  o.normal = Eigen::Vector2d(0.8, 0.6);
  return o;
}

/// The residuals of a cost whose block `varied` is replaced; with all derivatives by it.
template <int kRows, int kColumns>
void expect_derivative(const ceres::CostFunction& cost, std::vector<std::vector<double>> blocks,
                       std::size_t varied) {
  using Block = Eigen::Matrix<double, kColumns, 1>;
  const auto evaluate = [&](const Block& value, double* derivative) {
    for (int i = 0; i < kColumns; ++i) blocks[varied][static_cast<std::size_t>(i)] = value[i];
    std::vector<const double*> parameters;
    for (const auto& block : blocks) parameters.push_back(block.data());
    std::vector<double*> jacobians(blocks.size(), nullptr);
    jacobians[varied] = derivative;
    Eigen::Matrix<double, kRows, 1> residuals;
    EXPECT_TRUE(cost.Evaluate(parameters.data(), residuals.data(),
                              derivative != nullptr ? jacobians.data() : nullptr));
    return residuals;
  };
  const Block at = Eigen::Map<const Block>(blocks[varied].data());
  Eigen::Matrix<double, kRows, kColumns, Eigen::RowMajor> derivative;
  (void)evaluate(at, derivative.data());
  testing::expect_jacobian<kRows, kColumns>(
      Eigen::Matrix<double, kRows, kColumns>(derivative),
      [&](const Block& value) { return evaluate(value, nullptr); }, at);
}

TEST(WindowCosts, AnEventPairHasItsDerivatives) {
  const PinholeCamera camera = uneven_camera();
  // Of some pixels, so that the residuals are around 1.
  const EventPairCost cost({ObservedEvent{observation(0.1), 0, 0.3}, {observation(0.12), 0, 0.8}},
                           {0.02, 0.05}, camera);
  const std::vector<std::vector<double>> blocks = {{0.02, -0.01, 0.03, 0.01, 0.02, -0.015},
                                                   {0.01, 0.01, -0.02, 0.03, -0.01, 0.02},
                                                   {0.4, 0.1, 0.05, 0.2}};
  expect_derivative<2, 6>(cost, blocks, 0);
  expect_derivative<2, 6>(cost, blocks, 1);
  expect_derivative<2, 4>(cost, blocks, 2);
}

TEST(WindowCosts, AnEventWithoutWeightSaysNothing) {
  const PinholeCamera camera = uneven_camera();
  const EventPairCost cost({ObservedEvent{observation(0.1), 0, 0.3}, {observation(0.12), 0, 0.8}},
                           {1, 0}, camera);
  const std::array<double, 6> node{};
  const std::array<double, 4> edge = {0.4, 0, 0, 0};
  const std::array<const double*, 3> parameters = {node.data(), node.data(), edge.data()};
  std::array<double, 2> residuals{};
  ASSERT_TRUE(cost.Evaluate(parameters.data(), residuals.data(), nullptr));
  EXPECT_NE(residuals[0], 0);
  EXPECT_EQ(residuals[1], 0);
}

TEST(WindowCosts, PriorsHaveTheirDerivatives) {
  const Matrix6 root = image_motion_sqrt_information(uneven_camera(), 1.5, 0.7);
  const std::vector<double> node = {0.02, -0.01, 0.03, 0.01, 0.02, -0.015};
  const std::vector<double> other = {0.01, 0.01, -0.02, 0.03, -0.01, 0.02};
  const Twist mean = (Twist() << 0.1, 0.2, 0.3, 0.4, 0.5, 0.6).finished();
  expect_derivative<6, 6>(LinearPriorCost<6>(root, mean), {node}, 0);
  for (const std::size_t block : {0U, 1U})
    expect_derivative<6, 6>(LinearPriorCost<6>(root, mean, {-1, 1}), {node, other}, block);
  for (const std::size_t block : {0U, 1U, 2U, 3U})
    expect_derivative<6, 6>(LinearPriorCost<6>(root, mean, {0.1, 0.5, 0.35, 0.05}),
                            {node, other, other, node}, block);
  const Eigen::Matrix4d of_edge = root_of_sigma<4>({0.2, 0.4, 0.3, 0.5});
  expect_derivative<2, 4>(LinearPriorCost<4, 2>(of_edge.bottomRows<2>(), {0.1, 0.2, 0.3, 0.4}),
                          {{0.4, 0.1, 0.05, 0.2}}, 0);
}

/// A step to the side that a turn makes up for is hardly told; either alone is, to the pixel.
TEST(WindowCosts, ImageMotionTellsMotionsThatLookAlikeApartByLittle) {
  const PinholeCamera camera = uneven_camera();
  const double depth_m = 2;
  const Matrix6 root = image_motion_sqrt_information(camera, depth_m, 1);
  const double pixel_m = depth_m / camera.fx;
  const Twist aside = (Twist() << pixel_m, 0, 0, 0, 0, 0).finished();
  const Twist turn = (Twist() << 0, 0, 0, 0, 1 / camera.fx, 0).finished();
  EXPECT_NEAR((root * turn).norm(), 1, 0.2);
  EXPECT_NEAR((root * aside).norm(), std::sqrt((4 + 1 + 0.25) / 3), 1e-9);
  EXPECT_LT((root * (turn - aside)).norm(), (root * (turn + aside)).norm() / 2);
}

TEST(WindowCosts, TheRobustResidualIsTheRootOfCauchysLoss) {
  for (const double residual : {-7.0, -0.4, 0.0, 1e-7, 0.3, 50.0}) {
    const auto [value, slope] = cauchy_residual(residual, 2);
    EXPECT_NEAR(value * value, 4 * std::log1p(residual * residual / 4), 1e-9);
    EXPECT_EQ(std::signbit(value), std::signbit(residual));
    const double d = 1e-6;
    EXPECT_NEAR(
        slope,
        (cauchy_residual(residual + d, 2).first - cauchy_residual(residual - d, 2).first) / (2 * d),
        1e-8);
  }
}

}  // namespace
}  // namespace saccade
