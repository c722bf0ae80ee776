#include "estimator/edges/batch/path_edge_cost.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/jacobian_check.h"

namespace saccade {
namespace {

using EdgeColumns = Eigen::Matrix<double, 29, 1>;

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

}  // namespace
}  // namespace saccade
