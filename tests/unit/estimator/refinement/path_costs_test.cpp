#include "estimator/refinement/path_costs.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/jacobian_check.h"

namespace saccade {
namespace {

using EdgeColumns = Eigen::Matrix<double, 29, 1>;
using PoseColumns = Eigen::Matrix<double, 24, 1>;

const Eigen::Vector4d kWeight(0.1, 0.5, 0.35, 0.05);

template <class Vector>
Vector some_unknowns() {
  Vector x;
  for (Eigen::Index i = 0; i < x.size(); ++i) x[i] = 0.02 * std::sin(1.3 * static_cast<double>(i));
  return x;
}

PathEdgeCost some_cost(const Eigen::Vector3d& ray = {0.21, -0.13, 1}) {
  PinholeCamera camera;
  camera.width = 240;
  camera.height = 180;
  camera.fx = 200;
  camera.fy = 190;
  camera.cx = 118;
  camera.cy = 91;
  EdgeObservation o;
  o.view_from_camera = Rigid3::exp((Twist() << 0.1, -0.05, 0.02, 0.03, -0.02, 0.05).finished());
  o.ray = ray;
  o.lag = -1;
  o.pixel = {165, 62};
  o.normal = Eigen::Vector2d(0.8, 0.6);
  return {o, 1.5, camera, kWeight, 0.3};
}

TEST(PathEdgeCost, HasItsDerivatives) {
  const PathEdgeCost cost = some_cost();
  const auto evaluate = [&](const EdgeColumns& x, double** jacobians) {
    const double* blocks[] = {&x[0], &x[6], &x[12], &x[18], &x[24]};
    Eigen::Matrix<double, 1, 1> residual;
    EXPECT_TRUE(cost.Evaluate(blocks, residual.data(), jacobians));
    return residual;
  };
  auto at = some_unknowns<EdgeColumns>();
  at[24] = 0.4;
  EdgeColumns by;
  double* jacobians[] = {&by[0], &by[6], &by[12], &by[18], &by[24]};
  evaluate(at, jacobians);
  testing::expect_jacobian<1, 29>(
      by.transpose(), [&](const EdgeColumns& x) { return evaluate(x, nullptr); }, at);
}

TEST(PathEdgeCost, ARayThatLeadsAwayFromTheViewIsNoResidual) {
  const auto x = some_unknowns<EdgeColumns>();
  const double* blocks[] = {&x[0], &x[6], &x[12], &x[18], &x[24]};
  double residual = 0;
  EXPECT_FALSE(some_cost({0, 0, -1}).Evaluate(blocks, &residual, nullptr));
}

TEST(KnownPoseCost, HasItsDerivatives) {
  const Twist sigma = (Twist() << 0.1, 0.2, 0.3, 0.4, 0.5, 0.6).finished();
  const KnownPoseCost cost(some_unknowns<Twist>(), kWeight, sigma);
  const auto evaluate = [&](const PoseColumns& x, double** jacobians) {
    const double* blocks[] = {&x[0], &x[6], &x[12], &x[18]};
    Twist residuals;
    EXPECT_TRUE(cost.Evaluate(blocks, residuals.data(), jacobians));
    return residuals;
  };
  std::array<Eigen::Matrix<double, 6, 6, Eigen::RowMajor>, 4> by;
  double* jacobians[] = {by[0].data(), by[1].data(), by[2].data(), by[3].data()};
  const auto at = some_unknowns<PoseColumns>();
  evaluate(at, jacobians);
  Eigen::Matrix<double, 6, 24> all;
  all << by[0], by[1], by[2], by[3];
  testing::expect_jacobian<6, 24>(
      all, [&](const PoseColumns& x) { return evaluate(x, nullptr); }, at);
}

}  // namespace
}  // namespace saccade
