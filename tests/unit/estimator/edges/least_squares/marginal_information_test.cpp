#include "estimator/edges/least_squares/marginal_information.h"

#include <ceres/ceres.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <array>

namespace saccade {
namespace {

/// Row x of a linear least-squares problem over one kept block (2) and one eliminated block (1).
class Linear : public ceres::SizedCostFunction<1, 2, 1> {
 public:
  explicit Linear(double x) : x_(x) {}
  bool Evaluate(double const* const* p, double* residuals, double** jacobians) const override {
    const std::array<double, 3> by = {1 + x_, std::sin(x_), std::cos(2 * x_)};
    residuals[0] = by[0] * p[0][0] + by[1] * p[0][1] + by[2] * p[1][0] - x_;
    if (jacobians == nullptr) return true;
    if (jacobians[0] != nullptr) std::copy_n(by.begin(), 2, jacobians[0]);
    if (jacobians[1] != nullptr) jacobians[1][0] = by[2];
    return true;
  }

 private:
  double x_;
};

TEST(MarginalInformation, IsTheInverseOfTheBlockOfTheWholeCovariance) {
  std::array<double, 2> kept{};
  std::array<double, 3> offsets{};
  ceres::Problem problem;
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(30, 5);
  for (int i = 0; i < 30; ++i) {
    const double x = 0.1 * i;
    problem.AddResidualBlock(new Linear(x), nullptr, kept.data(),
                             &offsets[static_cast<std::size_t>(i % 3)]);
    jacobian(i, 0) = 1 + x;
    jacobian(i, 1) = std::sin(x);
    jacobian(i, 2 + i % 3) = std::cos(2 * x);
  }
  const Eigen::MatrixXd information =
      marginal_information(problem, {kept.data()}, {&offsets[0], &offsets[1], &offsets[2]});
  const Eigen::MatrixXd whole = (jacobian.transpose() * jacobian).inverse();
  EXPECT_LT((information.inverse() - whole.topLeftCorner(2, 2)).norm(), 1e-9 * whole.norm());
}

/// A residual that cannot be evaluated.
class Undefined : public ceres::SizedCostFunction<1, 2> {
 public:
  bool Evaluate(double const* const*, double*, double**) const override { return false; }
};

TEST(MarginalInformation, IsEmptyWhereAResidualCannotBeEvaluated) {
  std::array<double, 2> kept{};
  double offset = 0;
  ceres::Problem problem;
  for (int i = 0; i < 5; ++i)
    problem.AddResidualBlock(new Linear(0.1 * i), nullptr, kept.data(), &offset);
  ASSERT_EQ(marginal_information(problem, {kept.data()}, {&offset}).rows(), 2);
  problem.AddResidualBlock(new Undefined, nullptr, kept.data());
  EXPECT_EQ(marginal_information(problem, {kept.data()}, {&offset}).size(), 0);
}

}  // namespace
}  // namespace saccade
