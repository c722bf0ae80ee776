#include "estimator/edges/least_squares/prior_cost.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/rigid3.h"
#include "tests/support/jacobian_check.h"

namespace saccade {
namespace {

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

TEST(LinearPrior, HasItsDerivatives) {
  // Any root, full and not symmetric.
  Matrix6 root;
  for (int i = 0; i < 36; ++i) root.data()[i] = std::sin(1.7 * i);
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

}  // namespace
}  // namespace saccade
